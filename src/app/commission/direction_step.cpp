// In which direction a joint's motor and its encoder turn.
#include <cmath>

#include "app/bench/lead.h"
#include "app/bench/wiggle.h"
#include "commission_steps.h"

namespace kadans {
namespace {

constexpr double way_rad = 0.044;  // 2.5 degrees

// Wiggles it to see how its encoder follows its motor, then moves it in one direction and keeps it there.
class Turn final : public Push {
 public:
  Turn(std::size_t joint, const Wiggle::Settings& wiggle, const Lead::Settings& lead)
      : joint_(joint), wiggle_(wiggle), lead_settings_(lead), lead_(lead) {}

  void begin(const BenchSight& sight) override {
    if (relation_ == 0) return wiggle_.begin(sight);
    lead_ = Lead(lead_settings_);
    lead_.begin(sight);
  }
  double step(const BenchSight& sight) override {
    if (relation_ != 0) {
      went_rad_ = lead_.went_rad(sight);
      if (lead_.blocked() && !turned_back_) {  // it stands at its stop
        turned_back_ = true;
        lead_settings_.way_rad = -lead_settings_.way_rad;
        begin(sight);
      }
      return lead_.step(sight);
    }
    const double effort_Nm = wiggle_.step(sight);
    if (wiggle_.complete() && wiggle_.seen() && wiggle_.answers_rad()[joint_] != 0) {
      relation_ = lead_settings_.relation = wiggle_.answers_rad()[joint_] > 0 ? 1 : -1;
      begin(sight);
    }
    return effort_Nm;
  }
  std::string_view aborted() const override { return relation_ != 0 ? "" : wiggle_.aborted(); }
  bool complete() const override { return relation_ != 0 ? lead_.complete() : wiggle_.complete(); }
  double relation() const noexcept { return relation_; }  // 0: its encoder did not answer
  double went_rad() const noexcept { return went_rad_; }

 private:
  std::size_t joint_;
  Wiggle wiggle_;
  Lead::Settings lead_settings_;
  Lead lead_;
  double relation_ = 0, went_rad_ = 0;
  bool turned_back_ = false;
};

void flip(CommissionStep& step, const std::string& joint, std::string_view field, const std::string& what) {
  const bool reversed = !step.wiring.flag(joint, field);
  step.wiring.set(joint, field, reversed ? "true" : "false");
  step.session.tell("the sign of " + what + " of '" + joint + "' is wrong: \"" + std::string(field) +
                    "\": " + (reversed ? "true" : "false") + " corrects it");
}

void find_direction(CommissionStep& step, std::size_t joint, double inertia_kg_m2) {
  BenchSession& session = step.session;
  const std::string name = step.drive_name(joint);
  const bool coupled = step.robot.model.coupling_of(joint) != nullptr;
  const std::string called = (coupled ? "drive '" : "joint '") + name + "'";
  const double most_Nm = session.effort_max_Nm(joint);
  Turn turn(joint,
            {.joint = joint,
             .inertia_kg_m2 = inertia_kg_m2,
             .least_inertia_kg_m2 = inertia_kg_m2,
             .effort_max_Nm = most_Nm,
             .joints = step.robot.model.joints.size()},
            {.joint = joint, .inertia_kg_m2 = inertia_kg_m2, .effort_max_Nm = most_Nm, .way_rad = way_rad});
  const std::string positive = positive_turn_of_drive(step.robot.model, joint);
  const std::string stop =
      session.hold({.about = Question::About::positive,
                    .joint = name,
                    .text = (coupled ? "Drive '" : "Joint '") + name + "' trembles and then turns by " +
                            degrees_text(way_rad) + " while a key is held: look whether it turns " + positive},
                   joint, turn);
  if (!stop.empty()) return step.problem(called + ": " + stop);
  if (turn.relation() == 0)
    return step.problem(
        called + " was pushed, and its encoder did not answer: it is dead, or a brake that is stuck holds the joint");
  if (std::abs(turn.went_rad()) < way_rad / 3)
    return step.problem(called + " turned by " + degrees_text(turn.went_rad()) +
                        " only: something is in its way, or it needs a greater --share");
  const std::string answer = session.ask({.about = Question::About::positive,
                                          .joint = name,
                                          .text = "Did " + called + " turn " + positive + "?",
                                          .answers = {"yes", "no"}});
  const DriveWiringFields& fields = step.wiring.fields();
  const double encoder = (answer == "yes") == (turn.went_rad() > 0) ? 1 : -1, motor = encoder * turn.relation();
  if (fields.encoder_reversed == fields.motor_reversed) {
    if (encoder != motor)
      return step.problem("servo '" + name + "' turns against its own encoder: two servos may have the same id");
    if (encoder < 0) flip(step, name, fields.encoder_reversed, "the servo");
  } else {
    if (encoder < 0) flip(step, name, fields.encoder_reversed, "the encoder");
    if (motor < 0) flip(step, name, fields.motor_reversed, "the motor");
  }
  step.wiring.write();
  step.done(joint, encoder > 0 && motor > 0 ? "right" : "corrected");
  session.tell(called + ": a positive effort turns " + (coupled ? "" : "it ") + positive +
               ", and its encoder counts up");
}

}  // namespace

void find_directions(CommissionStep& step) {
  const std::vector<double> inertia_kg_m2 = inertias_kg_m2(step.robot, true);
  for (const std::size_t joint : step.joints) find_direction(step, joint, inertia_kg_m2[joint]);
}

}  // namespace kadans
