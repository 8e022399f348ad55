// A control object whose output for one joint is replaced once it is armed; everything else is another object's.
#pragma once

#include <memory>
#include <utility>

#include "kadans/control/control_object.h"

namespace kadans::failures {

class Saboteur final : public ControlObject {
 public:
  explicit Saboteur(std::unique_ptr<ControlObject> object) : object_(std::move(object)) {}

  void arm(std::size_t joint, const JointActuation& actuation) noexcept {
    joint_ = joint;
    actuation_ = actuation;
    armed_ = true;
  }
  void arm(std::size_t joint, double effort_Nm) noexcept {
    arm(joint, {.effort_Nm = effort_Nm, .mode = ActuationMode::effort});
  }
  void disarm() noexcept { armed_ = false; }

  void declare(Declaration& declaration) override { object_->declare(declaration); }
  void start(const ControlInput& input) noexcept override { object_->start(input); }
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override {
    object_->step(input, actuation);
    if (armed_) actuation.joints[joint_] = actuation_;
  }
  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override {
    object_->set_point(channel, value, duration_s);
  }
  void cancel_motion(std::uint32_t channel) noexcept override { object_->cancel_motion(channel); }
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override {
    return object_->setpoint_state(channel, state);
  }
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override { object_->follow(channel, state); }
  double motion_remaining_s() const noexcept override { return object_->motion_remaining_s(); }
  void parameters_changed() noexcept override { object_->parameters_changed(); }
  void pass_state(StateBytes& bytes) noexcept override { object_->pass_state(bytes); }
  void update(const Snapshot& snapshot) override { object_->update(snapshot); }

 private:
  std::unique_ptr<ControlObject> object_;
  std::size_t joint_ = 0;
  JointActuation actuation_;
  bool armed_ = false;
};

}  // namespace kadans::failures
