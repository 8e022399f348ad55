// A control object that applies the same law to each of its joints, independently of the others. This template is the
// object; `Law` is the mathematics of one joint. A law has:
//
//   explicit Law(const JointAxis& axis);
//   static constexpr std::uint32_t channels;                               // its set-points, numbered from 0
//   void declare(AxisTables& tables);
//   void start(const Takeover& takeover) noexcept;                         // takes over from the measured state
//   JointActuation step(const JointState& state, double dt_s) noexcept;
//   double remaining_s() const noexcept;
//   void pass_state(StateBytes& bytes) noexcept;                           // all that changes (state_bytes.h)
//
// A law whose set-point can be led along a motion that the engine plans (setpoint_motions.h) also has:
//
//   bool setpoint_state(std::uint32_t which, SetpointState& state) const noexcept;
//   void follow(std::uint32_t which, const SetpointState& state) noexcept;
//
// One that plans the way to its set-point itself has:
//
//   void set_point(std::uint32_t which, double value, double duration_s) noexcept;
//   void cancel(std::uint32_t which) noexcept;
//
// A law that can be rehearsed (control_object.h) also has:
//
//   void rehearse(const JointState& state, double dt_s) const noexcept;    // as step, on copies
//
// In the tick of the start, step() gets dt_s = 0. So a reference that starts at the joint's position does not run ahead
// of the measurement.
//
// A joint whose measured state is not finite gets an actuation that is not finite, which the safety layer stops. When
// the joint is measured again, start() takes it over anew.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/takeover.h"

namespace kadans {

template <typename Law>
class Jointwise : public ControlObject {
 public:
  // Throws std::invalid_argument for a passive joint.
  explicit Jointwise(const ObjectSetup& setup) {
    for (JointAxis& axis : joint_axes(setup)) {
      Law law(axis);
      parts_.push_back({std::move(axis), std::move(law)});
    }
  }

  void declare(Declaration& declaration) override {
    std::uint32_t channel = 0;
    for (Part& part : parts_) {
      AxisTables tables(declaration, part.axis, channel);
      part.law.declare(tables);
      channel += Law::channels;
    }
  }

  void start(const ControlInput& input) noexcept override {
    for (Part& part : parts_) take_over(part, input);
  }

  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override {
    for (Part& part : parts_) {
      if (!measured(part, input)) part.running = false;
      if (!part.running) take_over(part, input);
      const double dt_s = std::exchange(part.fresh, false) ? 0 : input.dt_s;
      actuation.joints[part.axis.joint] =
          part.running ? part.law.step(input.joints.joints[part.axis.joint], dt_s) : not_finite();
    }
  }

  void rehearse(const ControlInput& input) const noexcept override {
    if constexpr (rehearsed) {
      for (const Part& part : parts_) part.law.rehearse(input.joints.joints[part.axis.joint], input.dt_s);
    }
  }

  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override {
    if constexpr (plans) parts_[channel / Law::channels].law.set_point(channel % Law::channels, value, duration_s);
  }
  void cancel_motion(std::uint32_t channel) noexcept override {
    if constexpr (plans) parts_[channel / Law::channels].law.cancel(channel % Law::channels);
  }
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override {
    if constexpr (led) {
      return parts_[channel / Law::channels].law.setpoint_state(channel % Law::channels, state);
    } else {
      return ControlObject::setpoint_state(channel, state);
    }
  }
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override {
    if constexpr (led) parts_[channel / Law::channels].law.follow(channel % Law::channels, state);
  }
  double motion_remaining_s() const noexcept override {
    double remaining_s = 0;
    for (const Part& part : parts_) remaining_s = std::max(remaining_s, part.law.remaining_s());
    return remaining_s;
  }
  void pass_state(StateBytes& bytes) noexcept override {
    for (Part& part : parts_) bytes(part.law, part.running, part.fresh);
  }

 protected:
  std::size_t size() const noexcept { return parts_.size(); }
  Law& law(std::size_t i) noexcept { return parts_[i].law; }
  const JointAxis& axis(std::size_t i) const noexcept { return parts_[i].axis; }

 private:
  static constexpr bool led = requires(const Law& law, SetpointState& state) { law.setpoint_state(0U, state); };
  static constexpr bool plans = requires(Law & law) { law.set_point(0U, 0.0, 0.0); };
  static constexpr bool rehearsed = requires(const Law& law, const JointState& state) { law.rehearse(state, 0.0); };
  struct Part {
    JointAxis axis;
    Law law;
    bool running = false;
    bool fresh = false;  // started, not stepped yet
  };

  static bool measured(const Part& part, const ControlInput& input) noexcept {
    const JointState& state = input.joints.joints[part.axis.joint];
    return std::isfinite(state.position_rad) && std::isfinite(state.velocity_rad_s) && std::isfinite(state.effort_Nm);
  }
  static void take_over(Part& part, const ControlInput& input) noexcept {
    part.running = part.fresh = measured(part, input);
    if (!part.running) return;
    const std::size_t joint = part.axis.joint;
    part.law.start({input.joints.joints[joint], input.last.joints[joint], input.dt_s});
  }
  static JointActuation not_finite() noexcept {
    return {.effort_Nm = std::numeric_limits<double>::quiet_NaN(), .mode = ActuationMode::effort};
  }

  std::vector<Part> parts_;
};

}  // namespace kadans
