// The safety layer stands between what the control objects computed and what the plant is told. It checks the sensors,
// the state and the actuation of the last tick, and reduces what the robot may do, rung by rung: normal, limited, hold,
// damp, off.
//
// Watches find faults (joint_watch.h, body_watch.h); detection.h says how soon. Reactions say which rung follows,
// ladders keep the rung until it may be left (ladder.h). An emergency stop also brings the robot down
// (emergency_stop.h). What is asked of a joint that still works is cut to its limits (joint_limiter.h), and of coupled
// joints to their drives' (coupling_limiter.h); coupled joints go down the ladder together, for each of their drives
// moves both. An actuation that is not finite, or that asks coupled joints for two modes, is never written, whatever
// the configuration says.
//
// A joint that comes back from damp or off, by itself or because faults were cleared, gets its torque back over
// recover_s. came_back() says so in that tick: the control objects then start anew from the measured state, as at a
// switch of control sets. What was asked of the joint before is dropped.
//
// One owner, the control thread; check() neither allocates, locks nor throws.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "body_watch.h"
#include "coupling_limiter.h"
#include "emergency_stop.h"
#include "estimate/sensor_health.h"
#include "joint_limiter.h"
#include "joint_watch.h"
#include "kadans/exchange/ring.h"
#include "kadans/model/robot_model.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"
#include "ladder.h"
#include "settings.h"

namespace kadans {

inline constexpr std::size_t fault_log_capacity = 256;
using FaultLog = Ring<Fault, fault_log_capacity>;

struct SafetyInput {
  std::uint64_t tick;
  double dt_s;
  std::uint32_t missed_ticks;  // skipped before this one
  double heartbeat_age_s;      // since the behavior engine's last tick
  const SensorFrame& sensors;
  const JointStates& joints;
  const BaseStatus& base;
  const SensorHealth& health;
};

class Safety {
 public:
  // Throws std::invalid_argument unless there is one valid set of limits per joint of the model.
  Safety(const SafetySettings& settings, const RobotModel& model);

  // Before the loop. safety.level, .robot_level, .faults, .fall, .impact_m_s2, .missed_ticks and, by joint,
  // safety.<joint>.level, .temperature_C.
  void declare_signals(SignalTable& table, const RobotModel& model) const;

  // Limits the actuation in place, so that what remains may be written, and reports into `status`.
  void check(const SafetyInput& input, ActuationFrame& actuation, SafetyStatus& status) noexcept;
  // For rehearsals: takes over the state of `other`, a safety layer of the same robot; the log stays its own. Does not
  // allocate.
  void imitate(const Safety& other) noexcept;
  // All that changes from tick to tick (kadans/control/state_bytes.h), but what other threads asked of the emergency
  // stop, and the log.
  void pass_state(auto& bytes) noexcept {
    constexpr FaultMask unknown = ~((FaultMask{2} << (fault_codes - 1)) - 1);
    for (std::size_t i = 0; i < joint_count_; ++i) {
      JointGuard& joint = joints_[i];
      bytes(joint.watch, joint.drive, joint.ladder, joint.writable, joint.cut, joint.authority, joint.gave_way,
            joint.last_Nm, joint.driven, joint.level_number);
      bytes.must((joint.cut & unknown) == 0);
    }
    for (FootWatch& foot : feet_) bytes(foot);
    for (Ladder& ladder : foot_ladders_) bytes(ladder);
    for (std::size_t i = 0; i < settings_.channels.size(); ++i) bytes(channel_ladders_[i]);
    bytes(imu_, fall_, engine_, supply_, robot_, pending_, cut_, lost_, lasting_s_, last_dt_s_, change_s_, came_back_,
          stopped_by_, heard_, stopped_, lifts_, fault_count_, first_fault_, faults_raised_, new_faults_, level_number_,
          robot_level_number_);
    bytes.must(((pending_ | cut_) & unknown) == 0 && static_cast<std::size_t>(first_fault_.code) < fault_codes);
  }
  // Notes a fault that another part found; its reaction follows in the next check.
  void raise(const Fault& fault) noexcept;
  // Brings the robot down when asked; clear() and imitate() do not change it.
  EmergencyStop& emergency_stop() noexcept { return stop_; }
  // Lifts all latches: the next check judges anew. No effect while the emergency stop holds: that is lifted first.
  void clear() noexcept;
  bool stopped() const noexcept { return stopped_; }  // by the emergency stop, or its button
  // What the last check heard from other threads (StopHeard), and the words of who asked last.
  std::uint32_t heard() const noexcept { return heard_; }
  const FaultWords& stopped_by() const noexcept { return stopped_by_; }
  // Whether, in the last check or by a clear() since, joints that damped or were off began to follow again what is
  // asked of them. What is computed for the next tick must then start from the measured state.
  bool came_back() const noexcept { return came_back_; }

  // Faults as they happen, for another thread to pop. A full log drops faults; first_fault stays.
  FaultLog& log() noexcept { return log_; }
  const SafetySettings& settings() const noexcept { return settings_; }
  SafetyLevel robot_level() const noexcept { return robot_.level(); }
  // The worse of the joint's own rung and the robot's; limited while its torque comes back.
  SafetyLevel joint_level(std::size_t joint) const noexcept {
    const SafetyLevel recovering = joints_[joint].authority < 1 ? SafetyLevel::limited : SafetyLevel::normal;
    return std::max({ladder_level(joint), robot_.level(), recovering});
  }
  double temperature_C(std::size_t joint) const noexcept { return joints_[joint].watch.thermal().temperature_C(); }
  FallWatch::Phase fall_phase() const noexcept { return fall_.phase(); }

 private:
  struct JointGuard {
    JointWatch watch;
    DriveWatch drive;
    JointLimiter limiter;
    Ladder ladder;
    std::size_t partner = 0;  // the joint that it is coupled with, else itself
    bool writable = true;     // what was asked for in this tick: finite, and in one mode with its partner
    FaultMask cut = 0;        // by the limiter, in the last tick
    double authority = 1;     // share of the torque limit; grows after damp and off
    bool gave_way = false;    // in the last tick it damped or was off, whatever was asked
    double last_Nm = 0;       // written in the last tick
    bool driven = false;      // in the last tick something but off was written
    std::uint32_t level_number = 0;
  };

  void set_compliance(const Transmission& transmission);
  // What the joint's watches look at.
  JointWatch::Input of_joint(const SafetyInput& in, const ActuationFrame& actuation, std::size_t joint,
                             double dt_s) const noexcept {
    return {.state = in.joints.joints[joint],
            .sample = in.sensors.joints[joint],
            .health = in.health.joints[joint],
            .asked = actuation.joints[joint],
            .written_Nm = joints_[joint].last_Nm,
            .follows = !joints_[joint].gave_way,
            .dt_s = dt_s,
            .partner_Nm = in.sensors.joints[joints_[joint].partner].motor_effort_Nm};
  }
  DriveWatch::Input of_drive(const SafetyInput& in, std::size_t joint, double dt_s) const noexcept {
    return {in.sensors.joints[joint], joints_[joint].driven, in.sensors.time_ns, dt_s};
  }
  // Of the joint and the one that it is coupled with.
  SafetyLevel ladder_level(std::size_t joint) const noexcept {
    const JointGuard& own = joints_[joint];
    return own.partner == joint ? own.ladder.level()
                                : std::max(own.ladder.level(), joints_[own.partner].ladder.level());
  }
  // Whether the drives of coupled joints cannot do both: one mode at a time, effort with off as without torque.
  bool modes_differ(std::size_t joint, const ActuationFrame& asked) const noexcept {
    if (joints_[joint].partner == joint) return false;
    const ActuationMode own = asked.joints[joint].mode, other = asked.joints[joints_[joint].partner].mode;
    return own != other && std::max(own, other) > ActuationMode::effort;
  }
  FaultMask watch_body(const SafetyInput& input, double dt_s) noexcept;
  FaultMask watch_feet(const SafetyInput& input, double dt_s) noexcept;
  FaultMask watch_channels(const SafetyInput& input, double dt_s) noexcept;
  FaultMask watch_joints(const SafetyInput& input, const ActuationFrame& actuation, double dt_s) noexcept;
  void judge_joint(const SafetyInput& input, const ActuationFrame& actuation, std::size_t joint, FaultMask found,
                   double dt_s) noexcept;
  void judge_robot(const SafetyInput& input, FaultMask body, FaultMask others, double dt_s) noexcept;
  FaultMask take_stop(bool& lift) noexcept;
  void go_down(FaultMask faults, double dt_s) noexcept;
  [[gnu::always_inline]] bool passes(const SafetyInput& input, std::size_t joint,
                                     const JointActuation& actuation) noexcept;
  bool gives_way(std::size_t joint, double dt_s, const JointActuation& actuation) noexcept;
  void limit_joint(const SafetyInput& input, std::size_t joint, double dt_s, JointActuation& actuation) noexcept;
  void cut_coupling(const SafetyInput& input, CouplingLimiter& coupling, ActuationFrame& actuation) noexcept;
  void raise_cut(const SafetyInput& input, std::size_t joint, FaultMask cut, auto&& describe) noexcept;
  void cut_joint(const SafetyInput& input, std::size_t joint, JointActuation& actuation) noexcept;

  SafetySettings settings_;
  std::size_t joint_count_;
  std::array<JointGuard, max_joints> joints_{};
  std::vector<CouplingLimiter> couplings_;
  std::array<FootWatch, max_feet> feet_{};
  std::array<Ladder, max_feet> foot_ladders_{};  // only to report each foot's faults once
  std::array<ChannelWatch, max_channels> channels_{};
  std::array<Ladder, max_channels> channel_ladders_{};  // the same for each sensor channel
  ImuWatch imu_;
  FallWatch fall_;
  EngineWatch engine_;
  SupplyWatch supply_;
  Ladder robot_;
  FaultMask escalating_ = 0;  // codes whose reaction escalates
  FaultMask pending_ = 0;     // raised by others since the last check
  FaultMask cut_ = 0;         // of any joint, in the last tick
  std::uint32_t lost_ = 0;    // joints that damp or are off by themselves
  double lasting_s_ = 0;      // how long what escalates has lasted
  double last_dt_s_ = 0;      // of the last check
  double change_s_ = 0;       // the time in which the torque asked may have changed
  bool came_back_ = false;
  EmergencyStop stop_;
  FaultWords stopped_by_{};
  std::uint32_t heard_ = 0;
  bool stopped_ = false;  // by the emergency stop, until it is lifted
  std::uint16_t lifts_ = 0;
  std::uint32_t fault_count_ = 0;
  Fault first_fault_;
  std::uint64_t faults_raised_ = 0;
  std::array<NewFault, new_faults_shown> new_faults_{};
  FaultLog log_;
  std::uint32_t level_number_ = 0, robot_level_number_ = 0;
};

}  // namespace kadans
