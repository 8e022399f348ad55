// A control object of somebody else's: a spring and a damper on one joint, declared and stepped as the engine would.
#include "kadans/control/control_object.h"

#include <cstdio>
#include <vector>

namespace {

class Spring final : public kadans::ControlObject {
 public:
  void declare(kadans::Declaration& declaration) override {
    declaration.parameter(
        {.name = "stiffness_Nm_per_rad", .unit = "Nm/rad", .min = 0, .max = 100, .initial = 20, .doc = "Pull back."},
        &stiffness_Nm_per_rad_);
    declaration.signal({.name = "effort_Nm", .unit = "Nm", .doc = "Last torque."}, &effort_Nm_);
  }
  void start(const kadans::ControlInput&) noexcept override {}
  void step(const kadans::ControlInput& input, kadans::ActuationFrame& actuation) noexcept override {
    effort_Nm_ = -stiffness_Nm_per_rad_ * input.joints.joints[0].position_rad - input.joints.joints[0].velocity_rad_s;
    actuation.joints[0].mode = kadans::ActuationMode::effort;
    actuation.joints[0].effort_Nm = effort_Nm_;
  }
  void set_point(std::uint32_t, double, double) noexcept override {}
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }

 private:
  double stiffness_Nm_per_rad_ = 0;
  double effort_Nm_ = 0;
};

}  // namespace

int main() {
  kadans::ParameterTable parameters;
  kadans::SetpointTable setpoints;
  kadans::SignalTable signals;
  kadans::Declaration declaration("spring", 0, parameters, setpoints, signals);
  Spring spring;
  spring.declare(declaration);

  kadans::JointStates joints;
  joints.count = 1;
  joints.joints[0].position_rad = 0.5;
  const kadans::RobotStatus status;
  kadans::ActuationFrame actuation;
  spring.step({.joints = joints, .status = status, .last = actuation, .time_ns = 0, .dt_s = 0.001}, actuation);

  const auto id = signals.find("control.spring.effort_Nm");
  std::vector<double> row(signals.size());
  signals.gather(row);
  const bool ok =
      parameters.find("spring.stiffness_Nm_per_rad") && id && row[*id] == -10 && actuation.joints[0].effort_Nm == -10;
  std::printf("effort %.1f Nm: %s\n", actuation.joints[0].effort_Nm, ok ? "as the law says" : "wrong");
  return ok ? 0 : 1;
}
