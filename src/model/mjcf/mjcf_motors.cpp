#include "mjcf_motors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

using Xml = tinyxml2::XMLElement;

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double assumed_force = 100;  // N or Nm, of an actuator that says none

class MjcfMotors {
 public:
  MjcfMotors(UrdfDocument& document, const MjcfDefaults& defaults, const MjcfMotorSettings& settings,
             UrdfDescription& robot)
      : document_(document), defaults_(defaults), settings_(settings), robot_(robot) {}

  void run() {
    each_child(document_.root(), "tendon", [&](const Xml& e) { tendons(e); });
    each_child(document_.root(), "equality", [&](const Xml& e) { equalities(e); });
    each_child(document_.root(), "actuator", [&](const Xml& e) { actuators(e); });
    bound_efforts();
  }

 private:
  UrdfJoint* joint_named(const std::string& name) {
    const auto found =
        std::ranges::find_if(robot_.joints, [&](const UrdfJoint& joint) { return joint.moves && joint.name == name; });
    return found == robot_.joints.end() ? nullptr : &*found;
  }

  UrdfJoint* joint_of(const MjcfElement& e, const char* attribute) {
    const auto given = e.find(attribute);
    if (!given) return nullptr;
    UrdfJoint* const joint = joint_named(given->text);
    std::vector<std::string> names;
    for (const UrdfJoint& each : robot_.joints)
      if (each.moves) names.push_back(each.name);
    if (joint == nullptr)
      document_.refuse(given->at, "<" + shown(e.name()) + "> is of joint " + shown_quoted(given->text) +
                                      ", which does not exist" + did_you_mean(given->text, names));
    return joint;
  }

  void tendons(const Xml& all) {
    for (const Xml* e = all.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const char* const name = e->Attribute("name");
      std::vector<std::pair<std::string, double>>& parts = tendons_[name == nullptr ? "" : name];
      if (std::string_view(e->Name()) != "fixed") {
        document_.warn(tag_at(*e), "a <" + shown(e->Name()) + "> tendon is left out", "tendon");
        continue;
      }
      each_child(*e, "joint", [&](const Xml& part) {
        const MjcfElement of(document_, defaults_, part, {});
        parts.emplace_back(of.text("joint"), of.number("coef", 1));
      });
    }
  }

  void equalities(const Xml& all) {
    for (const Xml* xml = all.FirstChildElement(); xml != nullptr; xml = xml->NextSiblingElement()) {
      const MjcfElement e(document_, defaults_, *xml, {});
      if (!e.flag("active", true).value_or(true)) continue;
      if (e.name() == "connect" || e.name() == "weld") {
        document_.refuse(e.at(),
                         "<" + shown(e.name()) +
                             "> closes a loop, which no tree of joints has: leave the rod out, and write what drives "
                             "it as a <transmission> of two joints, or its joint as one that mimics another",
                         "closed loop");
        continue;
      }
      if (e.name() != "joint") {
        document_.warn(e.at(), "<" + shown(e.name()) + "> in <equality> is not used", "equality");
        continue;
      }
      UrdfJoint* const follower = joint_of(e, "joint1");
      UrdfJoint* const leader = joint_of(e, "joint2");
      const auto curve = e.numbers("polycoef", 1, 5, {0, 1, 0, 0, 0});
      const bool straight =
          std::all_of(curve.begin() + std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(curve.size())),
                      curve.end(), [](double c) { return c == 0; });
      if (follower == nullptr || leader == nullptr || !straight) {
        document_.warn(e.at(),
                       "this <joint> of <equality> is not used: a joint may follow another one along a line alone",
                       "equality");
        continue;
      }
      follower->mimic = UrdfMimic{leader->name, curve.size() > 1 ? curve[1] : 0, curve[0], e.at(), e.at()};
    }
  }

  void actuators(const Xml& all) {
    for (const Xml* xml = all.FirstChildElement(); xml != nullptr; xml = xml->NextSiblingElement()) {
      const MjcfElement e(document_, defaults_, *xml, {});
      std::vector<std::pair<UrdfJoint*, double>> moved;
      for (const char* const by : {"joint", "jointinparent"}) {
        if (UrdfJoint* const joint = joint_of(e, by)) moved.emplace_back(joint, 1);
      }
      if (const auto tendon = e.find("tendon")) {
        for (const auto& [joint, share] : tendons_[tendon->text]) {
          if (UrdfJoint* const part = joint_named(joint)) moved.emplace_back(part, std::abs(share));
        }
      }
      if (moved.empty()) {
        document_.warn(e.at(), "a <" + shown(e.name()) + "> that moves no joint of the robot is left out", "actuator");
        continue;
      }
      const double most = force_of(e) * std::abs(e.numbers("gear", 1, 6, {1})[0]);
      for (const auto& [joint, share] : moved) joint->joint.effort_max_Nm += share * most;
    }
  }

  // The most that an actuator gives before its gear; infinite when it does not say.
  double force_of(const MjcfElement& e) const {
    const auto larger = [](const std::vector<double>& range) {
      return std::max(std::abs(range[0]), std::abs(range[1]));
    };
    const bool bounded = e.flag("forcelimited").value_or(settings_.limits_by_range && e.has("forcerange"));
    const double force = bounded ? larger(e.numbers("forcerange", 2, 2, {0, 0})) : unlimited;
    const bool direct = e.name() == "motor" || (e.name() == "general" && e.text("biastype", "none") == "none" &&
                                                e.text("gaintype", "fixed") == "fixed");
    const bool commanded = e.flag("ctrllimited").value_or(settings_.limits_by_range && e.has("ctrlrange"));
    if (!direct || !commanded) return force;
    const double gain = e.name() == "general" ? std::abs(e.numbers("gainprm", 1, 10, {1})[0]) : 1;
    return std::min(force, gain * larger(e.numbers("ctrlrange", 2, 2, {0, 0})));
  }

  // An MJCF without actuators, driven by the program around it, says what its joints' motors give by their ranges.
  void bound_efforts() {
    const bool driven =
        std::ranges::any_of(robot_.joints, [](const UrdfJoint& joint) { return joint.joint.effort_max_Nm > 0; });
    for (UrdfJoint& joint : robot_.joints) {
      double& effort = joint.joint.effort_max_Nm;
      if (const auto most = settings_.joint_most.find(joint.name);
          most != settings_.joint_most.end() && (effort > 0 || !driven))
        effort = driven ? std::min(effort, most->second) : most->second;
      if (!std::isinf(effort)) continue;
      document_.warn(joint.at,
                     "joint " + shown_quoted(joint.name) +
                         " has an actuator without a limit of force: 100 Nm are assumed; forcerange says it",
                     "no force");
      effort = assumed_force;
    }
  }

  UrdfDocument& document_;
  const MjcfDefaults& defaults_;
  const MjcfMotorSettings& settings_;
  UrdfDescription& robot_;
  std::map<std::string, std::vector<std::pair<std::string, double>>> tendons_;  // joints and their shares
};

}  // namespace

void read_mjcf_motors(UrdfDocument& document, const MjcfDefaults& defaults, const MjcfMotorSettings& settings,
                      UrdfDescription& robot) {
  MjcfMotors(document, defaults, settings, robot).run();
}

}  // namespace kadans
