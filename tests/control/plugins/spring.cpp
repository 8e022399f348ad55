#include "spring.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace {

using namespace kadans;

class Spring final : public ControlObject {
 public:
  Spring(std::size_t joint, const Joint& described) : joint_(joint), range_(described.lower_rad, described.upper_rad) {}

  void declare(Declaration& declaration) override {
    declaration.parameter({"stiffness_Nm_per_rad", "Nm/rad", 0, 100, 20, "Pull to the rest position."}, &stiffness_);
    declaration.parameter({"damping_Nms_per_rad", "Nm s/rad", 0, 10, 1, "Against the velocity."}, &damping_);
    declaration.setpoint({.name = "rest_rad",
                          .unit = "rad",
                          .min = range_.first,
                          .max = range_.second,
                          .doc = "Rest.",
                          .channel = 7,
                          .joint = static_cast<std::uint32_t>(joint_)});
    declaration.signal({"effort_Nm", "Nm", "Last torque."}, &effort_Nm_);
    declaration.signal({"changes", "", "Times that parameters changed."}, &changes_);
  }
  void start(const ControlInput& input) noexcept override { rest_rad_ = input.joints.joints[joint_].position_rad; }
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override {
    const JointState& joint = input.joints.joints[joint_];
    effort_Nm_ = stiffness_ * (rest_rad_ - joint.position_rad) - damping_ * joint.velocity_rad_s;
    remaining_s_ = remaining_s_ > input.dt_s ? remaining_s_ - input.dt_s : 0;
    actuation.joints[joint_] = {.effort_Nm = effort_Nm_, .mode = ActuationMode::effort};
  }
  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override {
    if (channel == 7) rest_rad_ = value;
    remaining_s_ = duration_s;
  }
  void cancel_motion(std::uint32_t) noexcept override { remaining_s_ = 0; }
  double motion_remaining_s() const noexcept override { return remaining_s_; }
  void parameters_changed() noexcept override { ++changes_; }

 private:
  std::size_t joint_;
  std::pair<double, double> range_;
  double stiffness_ = 0, damping_ = 0, rest_rad_ = 0, effort_Nm_ = 0, remaining_s_ = 0;
  std::uint32_t changes_ = 0;
};

}  // namespace

std::unique_ptr<kadans::ControlObject> make_spring(const kadans::ObjectSetup& setup) {
  const Joint& joint = setup.model.joints.at(setup.joints.at(0));
  if (joint.passive()) throw std::invalid_argument("joint " + joint.name + " has no motor for a spring");
  const std::string* refused = setup.options.find("refuse");
  if (refused != nullptr) throw std::invalid_argument("told to refuse: " + *refused);
  return std::make_unique<Spring>(setup.joints[0], joint);
}
