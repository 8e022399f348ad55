// Where a joint's zero is, and how far it may go.
#include <algorithm>
#include <cmath>

#include "app/bench/lead.h"
#include "commission_steps.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double rad_of_degree = 0.017453292519943295;
constexpr double right_within_rad = 0.003, soft_margin_rad = 2 * rad_of_degree, least_range_rad = 5 * rad_of_degree;

std::string rad_text(double rad) { return printed("%.4g", std::round(rad * 1e4) / 1e4 + 0.0); }

// It asks for nothing: the drive itself looks for its zero, once that is ordered.
class LookForZero final : public Push {
 public:
  explicit LookForZero(const bool& homed) : homed_(homed) {}
  double step(const BenchSight&) override { return 0; }
  bool complete() const override { return homed_; }

 private:
  const bool& homed_;
};

// The drive in this joint's place stands further than it tells by so much. "\"home_rad\": 0.1"
std::string move_zero(CommissionStep& step, std::size_t joint, double off_rad) {
  const DriveWiringFields& fields = step.wiring.fields();
  const std::string name = step.joint_name(joint);
  const double before = step.number_at(joint, fields.zero, fields.zero_default);
  std::string now = rad_text(before + off_rad);
  if (fields.zero_turn > 0) {
    const double sign = step.wiring.flag(name, fields.encoder_reversed) ? -1 : 1;
    const double raw = std::round(before - sign * off_rad / fields.zero_unit_rad);
    now = std::to_string(std::lround(raw - fields.zero_turn * std::floor(raw / fields.zero_turn)));
  }
  step.wiring.set(name, fields.zero, now);
  return "\"" + std::string(fields.zero) + "\": " + now;
}

// The joint is at true_rad now. Writes where its zero is; where two drives move it, both stand elsewhere than they
// tell.
void write_zero(CommissionStep& step, std::size_t joint, double true_rad) {
  const std::string name = step.joint_name(joint);
  const double off_rad = true_rad - step.session.sight().position_rad[joint];
  if (std::abs(off_rad) < right_within_rad) {
    step.done(joint, "right");
    return step.session.tell("joint '" + name + "': its zero is right, within " + degrees_text(off_rad));
  }
  std::string now;
  if (const Transmission* const pair = step.robot.model.coupling_of(joint)) {
    const std::size_t own = pair->joints()[0] == joint ? 0 : 1;
    for (std::size_t drive = 0; drive < 2; ++drive) {
      const double per_joint = pair->drive_per_joint(drive, own);
      if (per_joint == 0) continue;
      now += (now.empty() ? "'" : ", '") + step.drive_name(pair->joints()[drive]) + "' " +
             move_zero(step, pair->joints()[drive], per_joint * off_rad);
    }
  } else {
    now = move_zero(step, joint, step.wiring.drive_per_joint(name) * off_rad);
  }
  step.wiring.write();
  step.done(joint, "corrected");
  step.session.tell("joint '" + name + "': its zero was wrong by " + degrees_text(off_rad) + ": " + now +
                    " corrects it");
}

void at_jig(CommissionStep& step, std::size_t joint) {
  const std::string name = step.joint_name(joint);
  const double degrees = step.session.ask_number(
      {.joint = name,
       .text = "Bring joint '" + name + "' by hand to a place that you know (a jig, a mark). Where is it, in degrees?"},
      -360, 360);
  write_zero(step, joint, degrees * rad_of_degree);
}

void at_stop(CommissionStep& step, std::size_t joint, double inertia_kg_m2, double direction) {
  BenchSession& session = step.session;
  const Joint& is = step.robot.model.joints[joint];
  const double stop_rad = direction < 0 ? is.lower_rad : is.upper_rad;
  if (!std::isfinite(stop_rad)) return step.problem("joint '" + is.name + "' has no stop there: its URDF says so");
  Lead lead({.joint = joint,
             .inertia_kg_m2 = inertia_kg_m2,
             .effort_max_Nm = session.effort_max_Nm(joint),
             .way_rad = direction * (is.upper_rad - is.lower_rad + 0.5),
             .speed_rad_s = 0.2,
             .behind_rad = 0.03,
             .seeks_stop = true});
  const std::string stop =
      session.hold({.about = Question::About::method,
                    .joint = is.name,
                    .text = "Joint '" + is.name + "' goes to its " + (direction < 0 ? "lower" : "upper") +
                            " stop while a key is held: look that nothing is in its way"},
                   joint, lead, true);
  if (!stop.empty()) return step.problem("joint '" + is.name + "': " + stop);
  if (!lead.blocked()) return step.problem("joint '" + is.name + "' did not come to its stop");
  // Where it was pushed into the stop; without torque it may have come back a little.
  const double back_rad = session.sight().position_rad[joint] - lead.last_rad();
  write_zero(step, joint, stop_rad + back_rad);
}

void at_home(CommissionStep& step, std::size_t joint) {
  BenchSession& session = step.session;
  const std::string name = step.joint_name(joint);
  const double most_Nm = std::abs(step.number_at(joint, "velocity_gain_Nms_per_rad", 0) *
                                  step.number_at(joint, "home_rad_s", 0.1) * step.wiring.drive_per_joint(name));
  if (most_Nm > session.effort_max_Nm(joint))
    return step.problem("joint '" + name + "': looking for its zero may take " + rad_text(most_Nm) +
                        " Nm, more than the share: a lower \"home_rad_s\" takes less");
  bool homed = false;
  LookForZero look(homed);
  session.watch_homing(joint, &homed);
  const std::string stop =
      session.hold({.about = Question::About::method,
                    .joint = name,
                    .text = "Joint '" + name + "' looks for its " + step.wiring.value(name, "home") +
                            " while a key is held: look that nothing is in its way"},
                   joint, look, true);
  session.watch_homing(joint, nullptr);
  if (!stop.empty()) return step.problem("joint '" + name + "': " + stop);
  if (!homed) return step.problem("joint '" + name + "' did not find its zero");
  session.tell("joint '" + name + "' has found its " + step.wiring.value(name, "home"));
  at_jig(step, joint);
}

void find_zero(CommissionStep& step, std::size_t joint, double inertia_kg_m2) {
  const std::string name = step.joint_name(joint);
  Question how{.about = Question::About::method,
               .joint = name,
               .text = "How is the zero of joint '" + name + "' found?",
               .answers = {"jig", "lower-stop", "upper-stop", "right"}};
  const std::string home = step.wiring.fields().home.empty() ? "" : step.wiring.value(name, step.wiring.fields().home);
  const bool coupled = step.robot.model.coupling_of(joint) != nullptr;
  if (!coupled && !home.empty() && home != "\"power_on\"") how.answers.insert(how.answers.begin() + 1, "home");
  const std::string method = step.session.ask(how);
  if (method == "right") return step.done(joint, "right");
  if (method == "jig") return at_jig(step, joint);
  if (method == "home") return at_home(step, joint);
  at_stop(step, joint, inertia_kg_m2, method == "lower-stop" ? -1 : 1);
}

void find_range(CommissionStep& step, std::size_t joint) {
  BenchSession& session = step.session;
  const Joint& is = step.robot.model.joints[joint];
  const std::string answer =
      session.ask({.about = Question::About::ready,
                   .joint = is.name,
                   .text = "Move joint '" + is.name + "' by hand from one end of what it may do to the other",
                   .answers = {"done", "skip"}});
  if (answer == "skip") return step.done(joint, "skipped");
  const BenchSession::Range range = session.range(joint);
  if (range.most_rad - range.least_rad < least_range_rad)
    return step.problem("joint '" + is.name + "' was moved by " + degrees_text(range.most_rad - range.least_rad) +
                        " only, or its encoder did not see it");
  const double lower_rad = range.least_rad + soft_margin_rad, upper_rad = range.most_rad - soft_margin_rad;
  if (range.least_rad < is.lower_rad - soft_margin_rad || range.most_rad > is.upper_rad + soft_margin_rad)
    return step.problem("joint '" + is.name + "' went from " + rad_text(range.least_rad) + " to " +
                        rad_text(range.most_rad) + " rad, beyond what its URDF says (" + rad_text(is.lower_rad) +
                        " to " + rad_text(is.upper_rad) + "): its zero or its scale is wrong, or the URDF is");
  if (lower_rad > is.lower_rad) step.wiring.set({"safety", "limits", is.name, "lower_rad"}, rad_text(lower_rad));
  if (upper_rad < is.upper_rad) step.wiring.set({"safety", "limits", is.name, "upper_rad"}, rad_text(upper_rad));
  step.wiring.write();
  step.done(joint, "found");
  session.tell("joint '" + is.name + "' goes from " + rad_text(range.least_rad) + " to " + rad_text(range.most_rad) +
               " rad: its soft limits are 2 degrees within");
}

}  // namespace

void find_zeros(CommissionStep& step) {
  const std::vector<double> inertia_kg_m2 = inertias_kg_m2(step.robot);
  for (const std::size_t joint : step.joints) find_zero(step, joint, inertia_kg_m2[joint]);
}

void find_limits(CommissionStep& step) {
  for (const std::size_t joint : step.joints) find_range(step, joint);
}

}  // namespace kadans
