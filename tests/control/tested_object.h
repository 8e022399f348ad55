// What the benches here have in common: a control object's tables, read and set by name, and the frames that it
// computes from and into.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/control/catalog.h"
#include "kadans/control/control_object.h"
#include "kadans/control/minimum_jerk.h"

namespace kadans::test {

class TestedObject {
 public:
  static constexpr double dt_s = 0.001;

  void set(const std::string& parameter, double value) {
    const auto id = catalog.parameters.find("it." + parameter);
    REQUIRE_MESSAGE(id, parameter);
    REQUIRE(catalog.parameters.set(*id, value));
    object_->parameters_changed();
  }
  double signal(const std::string& name) {
    catalog.signals.gather(row_);
    const auto id = catalog.signals.find("control.it." + name);
    REQUIRE_MESSAGE(id, name);
    return row_[*id];
  }
  double effort_Nm(std::size_t joint) const { return computed.joints[joint].effort_Nm; }

  // Leads a set-point as the engine does (setpoint_motions.h).
  void set_point(std::uint32_t channel, double value, double duration_s) {
    SetpointState at;
    if (plans(channel) || !object_->setpoint_state(channel, at)) return object_->set_point(channel, value, duration_s);
    motions_[channel].follow(at);
    motions_[channel].move(value, duration_s);
    if (!(duration_s > 0)) object_->follow(channel, {.value = value});
  }
  void cancel_motion(std::uint32_t channel) {
    SetpointState at;
    if (plans(channel) || !object_->setpoint_state(channel, at)) return object_->cancel_motion(channel);
    motions_[channel].follow(at);
    if (at.velocity != 0) motions_[channel].move(at.value + 0.05 * at.velocity, 0.1);
  }
  double motion_remaining_s() const noexcept {
    double left_s = object_->motion_remaining_s();
    for (const MinimumJerk& motion : motions_) left_s = std::max(left_s, motion.remaining_s());
    return left_s;
  }

  ControlInput input() const noexcept { return {joints, status, written, time_ns, dt_s}; }
  // The high level.
  void update() {
    snapshot.time_ns = time_ns;
    snapshot.joints = joints;
    object_->update(snapshot);
  }

  Catalog catalog;
  JointStates joints;
  RobotStatus status;
  ActuationFrame written, computed;
  Snapshot snapshot;
  std::int64_t time_ns = 0;
  bool high_level = true;

 protected:
  void declare(ControlObject& object, std::uint32_t joint_count) {
    object_ = &object;
    Declaration declaration("it", 0, catalog.parameters, catalog.setpoints, catalog.signals);
    object.declare(declaration);
    joints.count = written.joint_count = computed.joint_count = joint_count;
    row_.resize(catalog.signals.size());
  }
  void lead() noexcept {
    for (std::uint32_t channel = 0; channel < motions_.size(); ++channel) {
      if (!(motions_[channel].remaining_s() > 0)) continue;
      object_->follow(channel, motions_[channel].step(dt_s));
    }
  }
  // As the engines do it: what was computed in the last tick is written; the high level runs every tenth.
  void control_tick() {
    written = computed;
    lead();
    object_->step(input(), computed);
    if (high_level && time_ns % 10'000'000 == 0) update();
  }

 private:
  bool plans(std::uint32_t channel) const {
    for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) {
      if (catalog.setpoints[id].channel == channel) return catalog.setpoints[id].own_motion;
    }
    return false;
  }

  ControlObject* object_ = nullptr;
  std::array<MinimumJerk, 64> motions_;
  std::vector<double> row_;
};

}  // namespace kadans::test
