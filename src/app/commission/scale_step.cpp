// How strong a joint's drive is: the command that carries a known load.
#include <algorithm>
#include <cmath>

#include "app/bench/lead.h"
#include "commission_steps.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double N_per_kg = 9.81, carried_way_rad = 0.035, right_within = 0.02, least_share = 0.15, wrong_at_most = 5;

// Carries the joint where it stands, then moves it to one side, to the other and back, and takes the mean of the
// effort on the way there and on the way back: dry friction adds to the one what it takes from the other.
class Carry final : public Push {
 public:
  explicit Carry(const Lead::Settings& lead) : settings_(lead), lead_(lead) {}

  void begin(const BenchSight& sight) override {
    lead_ = Lead(settings_);
    lead_.begin(sight);
    phase_ = 0;
    ways_ = {};
    too_weak_ = false;
  }
  double step(const BenchSight& sight) override {
    const double effort_Nm = lead_.step(sight);
    const bool in_the_middle = std::abs(lead_.place_rad()) < 0.6 * carried_way_rad;
    if ((phase_ == 2 || phase_ == 3) && in_the_middle) {
      Way& way = ways_[static_cast<std::size_t>(phase_ - 2)];
      way.sum_Nm += effort_Nm;
      ++way.ticks;
    }
    too_weak_ = too_weak_ || (phase_ > 0 && std::abs(effort_Nm) > 0.999 * settings_.effort_max_Nm);
    if (lead_.complete() && phase_ < 4) lead_.go_on(goes_to_rad[static_cast<std::size_t>(phase_++)]);
    return effort_Nm;
  }
  bool complete() const override { return phase_ == 4 && lead_.complete(); }
  bool too_weak() const noexcept { return too_weak_; }  // its greatest effort was not enough
  double effort_Nm() const noexcept { return (mean_Nm(0) + mean_Nm(1)) / 2; }
  double friction_Nm() const noexcept { return std::abs(mean_Nm(0) - mean_Nm(1)) / 2; }

 private:
  struct Way {
    double sum_Nm = 0;
    int ticks = 0;
  };
  double mean_Nm(std::size_t way) const noexcept { return ways_[way].sum_Nm / std::max(1, ways_[way].ticks); }

  static constexpr std::array<double, 4> goes_to_rad{-carried_way_rad, carried_way_rad, -carried_way_rad, 0};

  Lead::Settings settings_;
  Lead lead_;
  bool too_weak_ = false;
  int phase_ = 0;  // it stands; to one side; to the other; back; to where it stood
  std::array<Way, 2> ways_{};
};

// The torque of the load that the person has; nothing when there is none.
std::optional<double> ask_load_Nm(CommissionStep& step, std::size_t joint) {
  BenchSession& session = step.session;
  const std::string name = step.joint_name(joint);
  const bool slides = step.robot.model.joints[joint].type == JointType::prismatic;
  const std::string with =
      session.ask({.about = Question::About::method,
                   .joint = name,
                   .text = "With what can joint '" + name + "' be loaded: a mass that hangs on it, or a spring scale?",
                   .answers = {"mass", "spring", "skip"}});
  if (with == "skip") return std::nullopt;
  const double force_N =
      with == "mass" ? N_per_kg * session.ask_number({.joint = name, .text = "How heavy is it, in kg?"}, 1e-4, 1e3)
                     : session.ask_number({.joint = name, .text = "How much does it pull, in N?"}, 1e-3, 1e4);
  if (slides) return force_N;
  return force_N * session.ask_number({.joint = name,
                                       .text = "How far from the joint's axis is that, in m, at a right angle to the "
                                               "load?"},
                                      1e-3, 10);
}

// False: it did not carry, and a sentence says why.
bool carry(CommissionStep& step, std::size_t joint, Carry& carry, bool loaded) {
  BenchSession& session = step.session;
  const std::string name = step.joint_name(joint);
  const std::string stop = session.hold(
      {.about = Question::About::load,
       .joint = name,
       .text = (loaded ? "Now the same with the load: hold joint '" : "Without a load: hold joint '") + name +
               "' by hand where its lever is at a right angle to the load. While a key is held its drive carries it "
               "and moves it by " +
               degrees_text(carried_way_rad) +
               ", either way: let it go slowly. Hold it again before the key is let go"},
      joint, carry);
  if (!stop.empty()) {
    step.problem("joint '" + name + "': " + stop);
  } else if (carry.too_weak()) {
    step.problem("joint '" + name + "' is not carried by " + printed("%.3g Nm", session.effort_max_Nm(joint)) +
                 ", as its scale is now: take a lighter load, or a greater --share");
  } else if (!carry.complete()) {
    step.problem("joint '" + name + "' was not carried up and down: hold the key for longer");
  } else {
    return true;
  }
  return false;
}

void find_scale(CommissionStep& step, std::size_t joint, double inertia_kg_m2) {
  BenchSession& session = step.session;
  const std::string name = step.joint_name(joint);
  const DriveConstants::Field scale = step.wiring.constants_of(name).scale;
  if (scale.name.empty()) {
    session.tell("joint '" + name + "': no scale in the configuration belongs to its torque");
    return step.done(joint, "none");
  }
  if (step.robot.model.coupling_of(joint) != nullptr) {
    session.tell("joint '" + name + "' is moved by two drives: a load at the joint does not tell their scales apart");
    return step.done(joint, "none");
  }
  const std::optional<double> load_Nm = ask_load_Nm(step, joint);
  if (!load_Nm) return step.done(joint, "skipped");
  const double most_Nm = session.effort_max_Nm(joint);
  if (!(*load_Nm >= least_share * most_Nm && *load_Nm <= 0.9 * most_Nm))
    return step.problem("joint '" + name + "': a load of " + printed("%.3g Nm", *load_Nm) + " is no good here: from " +
                        printed("%.3g Nm", least_share * most_Nm) + ", which can be measured, to " +
                        printed("%.3g Nm", 0.9 * most_Nm) + ", which --share allows");
  const Lead::Settings lead{.joint = joint,
                            .inertia_kg_m2 = inertia_kg_m2,
                            .effort_max_Nm = most_Nm,
                            .way_rad = 0,
                            .speed_rad_s = 0.03,
                            .bandwidth_rad_s = 25,
                            .stays_s = 3};
  Carry empty(lead), loaded(lead);
  if (!carry(step, joint, empty, false) || !carry(step, joint, loaded, true)) return;
  const double needed_Nm = std::abs(loaded.effort_Nm() - empty.effort_Nm());
  const std::string measured = "joint '" + name + "' carries " + printed("%.3g Nm", *load_Nm) + " with a command of " +
                               printed("%.3g Nm", needed_Nm) +
                               " (friction: " + printed("%.3g Nm", loaded.friction_Nm()) + ")";
  if (!(needed_Nm > *load_Nm / wrong_at_most && needed_Nm < *load_Nm * wrong_at_most))
    return step.problem(measured +
                        ": that is no wrong scale; look at the load, its lever, and what else holds the joint");
  const double factor = *load_Nm / needed_Nm;
  if (std::abs(factor - 1) < right_within) {
    session.tell(measured + ": the scale of its amplifier is right");
    return step.done(joint, "right");
  }
  const std::string now = printed("%.4g", scale.value * factor);
  const std::string field = "\"" + std::string(scale.name) + "\": " + now;
  const std::string answer =
      session.ask({.about = Question::About::agreed,
                   .joint = name,
                   .text = measured + ": the scale of its amplifier is wrong by " +
                           printed("%.3g %%", 100 * std::abs(factor - 1)) + "; is " + field + " to be written?",
                   .answers = {"yes", "no"}});
  if (answer == "no") return step.done(joint, "kept");
  step.wiring.set(name, scale.name, now);
  step.wiring.write();
  step.done(joint, "corrected");
  session.tell("joint '" + name + "': " + field + " is written");
}

}  // namespace

void find_scales(CommissionStep& step) {
  const std::vector<double> inertia_kg_m2 = inertias_kg_m2(step.robot);
  for (const std::size_t joint : step.joints) find_scale(step, joint, inertia_kg_m2[joint]);
}

}  // namespace kadans
