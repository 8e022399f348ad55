// What a joint's inertia, friction and delay are, and which gains follow from them.
#include <algorithm>
#include <array>
#include <cmath>

#include "app/author/stance.h"
#include "app/bench/small_step.h"
#include "app/bench/swing.h"
#include "commission_steps.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double residual_max = 0.3;

struct Gains {
  double stiffness_Nm_per_rad = 0, damping_Nms_per_rad = 0;
};

// Two fields of the configuration that are gains of one joint, and by what theirs are multiplied to be Nm/rad and
// Nms/rad.
struct GainFields {
  std::vector<std::string> stiffness, damping;  // paths
  std::string of;                               // who has them
  Gains now;
  double unit = 1;
};

// The gains of control objects that lead single joints: the ends of their parameters' names.
struct GainLaw {
  const char *stiffness, *damping;
  bool by_inertia;
};
constexpr std::array<GainLaw, 3> gain_laws{{{"kp_Nm_per_rad", "kd_Nms_per_rad", false},
                                            {"stiffness_Nm_per_rad", "damping_Nms_per_rad", false},
                                            {"kp_per_s2", "kd_per_s", true}}};

std::string text_of(double value) { return printed("%.3g", value); }
std::string told(const Gains& gains) {
  return text_of(gains.stiffness_Nm_per_rad) + " Nm/rad and " + text_of(gains.damping_Nms_per_rad) + " Nms/rad";
}

// Where this joint's gains are written: those of control objects, and of the plant's own position mode.
std::vector<GainFields> fields_of(CommissionStep& step, const ParameterTable& parameters, std::size_t joint,
                                  double inertia_kg_m2) {
  const std::string name = step.joint_name(joint);
  std::vector<GainFields> all;
  for (const ObjectConfig& object : step.robot.objects) {
    for (const GainLaw& law : gain_laws) {
      const std::string of = object.name + "." + name + ".";
      const auto stiffness = parameters.find(of + law.stiffness), damping = parameters.find(of + law.damping);
      if (!stiffness || !damping) continue;
      const std::vector<std::string> path{"control", "objects", "[" + object.name + "]", "parameters"};
      GainFields fields{.stiffness = path,
                        .damping = path,
                        .of = "'" + object.name + "' (" + object.type.name + ")",
                        .now = {parameters.newest(*stiffness), parameters.newest(*damping)},
                        .unit = law.by_inertia ? inertia_kg_m2 : 1};
      fields.stiffness.push_back(name + "." + law.stiffness);
      fields.damping.push_back(name + "." + law.damping);
      all.push_back(fields);
    }
  }
  if (step.robot.model.coupling_of(joint) != nullptr) return all;
  const DriveConstants drive = step.wiring.constants_of(name);
  const double squared = std::pow(step.wiring.drive_per_joint(name), 2);  // of what a drive's gain is at its joint
  if (!drive.stiffness.name.empty() && drive.stiffness.value > 0)
    all.push_back({.stiffness = step.wiring.path_of(name, drive.stiffness.name),
                   .damping = step.wiring.path_of(name, drive.damping.name),
                   .of = "the position mode of drive '" + name + "'",
                   .now = {drive.stiffness.value, drive.damping.value},
                   .unit = squared});
  const DriveSettings& model = step.robot.plant.drives[joint];
  if (!drive.stiffness.name.empty() && model.position_gain_Nm_per_rad > 0) {
    const std::vector<std::string> path{"plant", "drives", step.wiring.drive_name(name)};
    all.push_back({.stiffness = path,
                   .damping = path,
                   .of = "the same in plant.drives",
                   .now = {model.position_gain_Nm_per_rad, model.velocity_gain_Nms_per_rad}});
    all.back().stiffness.emplace_back("position_gain_Nm_per_rad");
    all.back().damping.emplace_back("velocity_gain_Nms_per_rad");
  }
  return all;
}

// Nothing: it could not be measured, and a sentence says why.
std::optional<JointFit> measure(CommissionStep& step, std::size_t joint, double inertia_kg_m2) {
  BenchSession& session = step.session;
  const std::string name = step.joint_name(joint);
  Swing swing({.joint = joint, .inertia_kg_m2 = inertia_kg_m2, .effort_max_Nm = session.effort_max_Nm(joint)});
  const std::string stop = session.hold(
      {.about = Question::About::load,
       .joint = name,
       .text = "Joint '" + name +
               "' swings by a degree or two, ever faster, while a key is held: let it hang freely, or hold it by "
               "hand and let it go slowly"},
      joint, swing);
  const JointFit fit = swing.fit();
  if (!stop.empty()) {
    step.problem("joint '" + name + "': " + stop);
  } else if (!swing.complete()) {
    step.problem("joint '" + name + "' was not measured: hold the key for longer");
  } else if (!swing.moved()) {
    step.problem("joint '" + name + "' hardly moved: friction or a brake holds it; a greater --share may move it");
  } else if (!(fit.residual < residual_max && fit.inertia_kg_m2 > 0)) {
    step.problem("joint '" + name + "' does not move like a mass with friction (" + text_of(100 * fit.residual) +
                 " % of its torque is not explained): look for play, a soft coupling, or what touches it");
  } else {
    return fit;
  }
  return std::nullopt;
}

// Whether a small step with these gains goes well.
bool goes_well(CommissionStep& step, std::size_t joint, double inertia_kg_m2, const Gains& gains) {
  BenchSession& session = step.session;
  const std::string name = step.joint_name(joint);
  SmallStep small({.joint = joint,
                   .inertia_kg_m2 = inertia_kg_m2,
                   .stiffness_Nm_per_rad = gains.stiffness_Nm_per_rad,
                   .damping_Nms_per_rad = gains.damping_Nms_per_rad,
                   .effort_max_Nm = session.effort_max_Nm(joint),
                   .velocity_cutoff_Hz = step.robot.estimate.cutoff_Hz(joint),
                   .period_s = step.robot.engine.control_period_s});
  const std::string stop = session.hold(
      {.about = Question::About::load,
       .joint = name,
       .text = "Joint '" + name + "' is held with " + told(gains) +
               " and steps by a degree and back while a key is held: let it hang freely, or hold it by hand "
               "before and after"},
      joint, small);
  if (!stop.empty()) {
    step.problem("joint '" + name + "' with " + told(gains) + ": " + stop);
  } else if (!small.complete()) {
    step.problem("joint '" + name + "' did not make its step: hold the key for longer");
  } else {
    session.tell("joint '" + name + "' with " + told(gains) + ": came to " + text_of(100 * small.reached()) +
                 " % of its step, and went " + text_of(100 * small.overshoot()) + " % beyond it");
    return true;
  }
  return false;
}

void write_gains(CommissionStep& step, std::size_t joint, const Gains& gains, const std::vector<GainFields>& all) {
  for (const GainFields& fields : all) {
    step.wiring.set(fields.stiffness, text_of(gains.stiffness_Nm_per_rad / fields.unit));
    step.wiring.set(fields.damping, text_of(gains.damping_Nms_per_rad / fields.unit));
  }
  step.wiring.write();
  step.done(joint, "written");
  step.session.tell("joint '" + step.joint_name(joint) + "': " + told(gains) + " are written for " +
                    listed(all, &GainFields::of));
}

void find_joint_gains(CommissionStep& step, const ParameterTable& parameters, std::size_t joint, double inertia_kg_m2,
                      const StandingPose& stance) {
  BenchSession& session = step.session;
  const std::string name = step.joint_name(joint);
  const std::optional<JointFit> fit = measure(step, joint, inertia_kg_m2);
  if (!fit) return;
  // What a control object computes is written a tick later.
  std::vector<JointLoop> loops(step.robot.model.joints.size());
  loops[joint] = {.inertia_kg_m2 = fit->inertia_kg_m2,
                  .friction_Nm = std::max(0.0, fit->coulomb_Nm),
                  .delay_s = fit->delay_s + step.robot.engine.control_period_s,
                  .velocity_cutoff_Hz = step.robot.estimate.cutoff_Hz(joint)};
  const JointHold hold = hold_joints(step.robot.model, stance, loops)[joint];
  Gains gains{hold.stiffness_Nm_per_rad, hold.damping_Nms_per_rad};
  session.tell("joint '" + name + "': inertia " + text_of(fit->inertia_kg_m2) + " kg m2, friction " +
               text_of(fit->coulomb_Nm) + " Nm and " + text_of(fit->viscous_Nms_per_rad) + " Nms/rad, delay " +
               text_of(1e3 * fit->delay_s) + " ms");
  const std::vector<GainFields> fields = fields_of(step, parameters, joint, fit->inertia_kg_m2);
  if (fields.empty()) {
    session.tell("joint '" + name + "': nothing in the configuration has gains of this joint alone");
    return step.done(joint, "measured");
  }
  std::string now;
  for (const GainFields& one : fields)
    now += (now.empty() ? "" : ", ") + one.of + " has " +
           told({one.now.stiffness_Nm_per_rad * one.unit, one.now.damping_Nms_per_rad * one.unit});
  const std::string answer =
      session.ask({.about = Question::About::gains,
                   .joint = name,
                   .text = "Gains of joint '" + name + "': " + told(gains) + " are proposed, at most " +
                           text_of(stiffest_per_s2(loops[joint]) * fit->inertia_kg_m2) + " Nm/rad; " + now +
                           ". Take those proposed, others (you say which), or keep what there is?",
                   .answers = {"take", "others", "keep"}});
  if (answer == "keep") return step.done(joint, "kept");
  if (answer == "others") {
    gains.stiffness_Nm_per_rad = session.ask_number({.joint = name, .text = "Stiffness, in Nm/rad?"}, 1e-6, 1e5);
    gains.damping_Nms_per_rad = session.ask_number({.joint = name, .text = "Damping, in Nms/rad?"}, 0, 1e4);
  }
  if (goes_well(step, joint, fit->inertia_kg_m2, gains)) write_gains(step, joint, gains, fields);
}

}  // namespace

void find_gains(CommissionStep& step) {
  const std::vector<double> inertia_kg_m2 = inertias_kg_m2(step.robot);
  const StandingPose stance = find_stance(step.robot.model);
  const std::unique_ptr<ControlSystem> control = make_control_system(step.files);
  for (const std::size_t joint : step.joints)
    find_joint_gains(step, control->catalog.parameters, joint, inertia_kg_m2[joint], stance);
}

}  // namespace kadans
