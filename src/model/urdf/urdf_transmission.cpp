// <transmission>: the gear and the rotor of a joint's motor, and couplings of two joints. In three forms, which differ
// in where the numbers stand:
//
//   ROS           <transmission><type>.../SimpleTransmission</type><joint name/>
//                   <actuator name><mechanicalReduction>50</mechanicalReduction></actuator></transmission>
//   PR2           <transmission type=".../SimpleTransmission"><joint/><actuator/><mechanicalReduction>
//   ros2_control  <ros2_control><transmission><plugin>...</plugin><joint role="joint1"><mechanical_reduction>
//
// <motorInertia> and drake:rotor_inertia count before the gear; a joint's rotor inertia behind it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "kadans/signal/nearest_name.h"
#include "urdf_description.h"
#include "urdf_document.h"

namespace kadans {
namespace {

using tinyxml2::XMLElement;

struct TransmissionSide {  // a joint or a drive
  std::string name, role;
  double reduction = 1, offset_rad = 0, rotor_inertia_kg_m2 = 0, gear = 0;
};

class TransmissionReader {
 public:
  TransmissionReader(UrdfDocument& document, const XMLElement& element, UrdfDescription& robot)
      : document_(document), element_(element), robot_(robot), at_(UrdfElement(document, element).at()) {}

  void run() {
    const UrdfDocument::Lenient lenient(document_, "1 is taken");
    read_sides();
    if (!take_type() || !known_joints()) return;
    const std::size_t wanted = made_.settings.kind == Transmission::Kind::simple ? 1 : 2;
    if (joints_.size() != wanted || (wanted == 2 && drives_.size() != wanted)) {
      return left_out("has " + std::to_string(joints_.size()) + " joints and " + std::to_string(drives_.size()) +
                          " actuators: this type takes " + std::to_string(wanted),
                      "transmission sides");
    }
    wanted == 1 ? simple() : coupled();
  }

 private:
  void left_out(const std::string& why, std::string_view kind) {
    const char* const name = element_.Attribute("name");
    document_.warn(at_, "transmission " + shown_quoted(name == nullptr ? "" : name) + " " + why + "; it is not used",
                   kind);
  }

  static std::string text_of(const XMLElement& e) { return e.GetText() == nullptr ? "" : e.GetText(); }

  double number_of(const XMLElement& e) {
    const char* const given = e.Attribute("value");  // Drake's form
    const std::string text = given == nullptr ? text_of(e) : given;
    double value = 1;
    if (const auto defect = read_value(UrdfValue::number, text, &value))
      document_.refuse(UrdfElement(document_, e).at(),
                       "<" + shown(e.Name()) + "> " + shown_quoted(text) + " " + *defect);
    return value;
  }

  TransmissionSide side(const XMLElement& e) {
    TransmissionSide side;
    if (const char* const name = e.Attribute("name")) side.name = name;
    if (const char* const role = e.Attribute("role")) side.role = role;
    for (const auto* child = e.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
      const std::string_view what = child->Name();
      if (what == "role") side.role = text_of(*child);
      if (what == "mechanicalReduction" || what == "mechanical_reduction") side.reduction = number_of(*child);
      if (what == "offset") side.offset_rad = number_of(*child);
      if (what == "motorInertia" || what == "drake:rotor_inertia") side.rotor_inertia_kg_m2 = number_of(*child);
      if (what == "drake:gear_ratio") side.gear = number_of(*child);
    }
    return side;
  }

  void read_sides() {
    double reduction = 1;
    for (const auto* e = element_.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view what = e->Name();
      if (what == "joint") joints_.push_back(side(*e));
      if (what == "actuator") drives_.push_back(side(*e));
      if (what == "mechanicalReduction") reduction = number_of(*e);
    }
    if (!drives_.empty()) drives_[0].reduction *= reduction;
    std::ranges::stable_sort(joints_, {}, &TransmissionSide::role);
    std::ranges::stable_sort(drives_, {}, &TransmissionSide::role);
  }

  bool take_type() {
    std::string type;
    if (const char* const given = element_.Attribute("type")) type = given;
    for (const char* const name : {"type", "plugin"})
      if (const XMLElement* const e = element_.FirstChildElement(name)) type = text_of(*e);
    const std::string_view kind = std::string_view(type).substr(type.rfind('/') + 1);
    using enum Transmission::Kind;
    if (kind == "DifferentialTransmission") made_.settings.kind = differential;
    if (kind == "FourBarLinkageTransmission") made_.settings.kind = four_bar_linkage;
    if (kind.empty() || kind == "SimpleTransmission" || made_.settings.kind != simple) return true;
    left_out("has the type " + shown_quoted(type) + ", which is not known", type);
    return false;
  }

  bool known_joints() {
    for (const TransmissionSide& joint : joints_) {
      const auto found = std::ranges::find(robot_.joints, joint.name, &UrdfJoint::name);
      if (found == robot_.joints.end()) {
        left_out("is of joint " + shown_quoted(joint.name) + ", which does not exist" +
                     did_you_mean(joint.name, names_of(robot_.joints)),
                 "transmission of no joint");
        return false;
      }
      if (!found->moves || found->joint.passive()) {
        const bool none = !found->moves;
        left_out("is of joint " + shown_quoted(joint.name) + (none ? ", which is fixed" : ", which has no effort"),
                 none ? "transmission of a fixed joint" : "transmission of a passive joint");
        return false;
      }
      if (std::ranges::any_of(robot_.transmissions, [&](const UrdfTransmission& other) {
            return std::ranges::find(other.joints, joint.name) != other.joints.end();
          })) {
        left_out("is a second one of joint " + shown_quoted(joint.name), "second transmission");
        return false;
      }
      made_.joints.push_back(joint.name);
    }
    return true;
  }

  void simple() {
    TransmissionSide& joint = joints_[0];
    const TransmissionSide drive = drives_.empty() ? TransmissionSide{} : drives_[0];
    const double ratio = joint.reduction * drive.reduction;
    const double gear = drive.gear > 0 ? drive.gear : ratio;
    Joint& of = std::ranges::find(robot_.joints, joint.name, &UrdfJoint::name)->joint;
    if (drive.rotor_inertia_kg_m2 > 0) of.rotor_inertia_kg_m2 = drive.rotor_inertia_kg_m2 * gear * gear;
    if (ratio != 1 || joint.offset_rad != 0) add();
  }

  void coupled() {
    made_.settings.drives = names_of(drives_);
    const std::vector<std::string>& names = made_.settings.drives;
    if (!is_word(names[0]) || !is_word(names[1]) || names[0].empty() || names[1].empty() || taken(names[0]) ||
        taken(names[1]))
      made_.settings.drives.clear();
    add();
  }

  bool taken(const std::string& name) const {
    return std::ranges::find(robot_.joints, name, &UrdfJoint::name) != robot_.joints.end();
  }

  void add() {
    for (const TransmissionSide& joint : joints_) {
      made_.settings.joint_reduction.push_back(joint.reduction);
      made_.settings.joint_offset_rad.push_back(joint.offset_rad);
    }
    for (const TransmissionSide& drive : drives_) made_.settings.actuator_reduction.push_back(drive.reduction);
    try {
      UrdfTransmission tried = made_;
      for (std::size_t i = 0; i < joints_.size(); ++i) tried.settings.joints.push_back(i);
      (void)Transmission(tried.settings);
    } catch (const std::invalid_argument& error) {
      return left_out(std::string("cannot be: ") + error.what(), error.what());
    }
    made_.at = at_;
    robot_.transmissions.push_back(made_);
  }

  UrdfDocument& document_;
  const XMLElement& element_;
  UrdfDescription& robot_;
  std::size_t at_;
  std::vector<TransmissionSide> joints_, drives_;
  UrdfTransmission made_;
};

}  // namespace

void read_transmission(UrdfDocument& document, const XMLElement& element, UrdfDescription& robot) {
  TransmissionReader(document, element, robot).run();
}

}  // namespace kadans
