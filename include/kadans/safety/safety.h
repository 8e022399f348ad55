// The safety layer: between what control objects computed and what the plant is told. It looks at the state and at the
// actuation of the last tick and lets the robot do less, rung by rung: normal, limited, hold, damp, off.
//
// A joint that breaks a limit, loses its sensor or is given a value that is not finite degrades alone and stays there
// until the faults are cleared. The robot as a whole goes to hold, then damp, then off when the behavior engine falls
// silent: hold keeps the last set-points, damp turns every joint into a damper, off gives no torque.
//
// One owner, the control thread; check() neither allocates, locks nor throws.
#pragma once

#include <array>
#include <cstdint>

#include "kadans/estimate/sensor_health.h"
#include "kadans/exchange/ring.h"
#include "kadans/model/robot_model.h"
#include "kadans/safety/settings.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/status.h"

namespace kadans {

inline constexpr std::size_t fault_log_capacity = 256;
using FaultLog = Ring<Fault, fault_log_capacity>;

struct SafetyInput {
  std::uint64_t tick;
  double dt_s;
  std::uint32_t missed_ticks;  // skipped before this one
  double heartbeat_age_s;      // since the behavior engine's last tick
  const JointStates& joints;
  const SensorHealth& health;
};

class Safety {
 public:
  // Throws std::invalid_argument unless there is one sane set of limits a joint of the model.
  Safety(const SafetySettings& settings, const RobotModel& model);

  // Limits the actuation in place, so that what remains may be written, and reports into `status`.
  void check(const SafetyInput& input, ActuationFrame& actuation, SafetyStatus& status) noexcept;
  // Notes a fault that somebody else found; it does not change the level.
  void raise(const Fault& fault) noexcept;
  // Lifts all latches: the next check judges anew.
  void clear() noexcept;

  // Faults as they happen, for another thread to pop. A full log drops, first_fault stays.
  FaultLog& log() noexcept { return log_; }
  SafetyLevel joint_level(std::size_t joint) const noexcept { return joint_levels_[joint]; }
  const std::uint32_t& level_signal() const noexcept { return level_number_; }

 private:
  void watch_engine(const SafetyInput& input) noexcept;
  void watch_joint(const SafetyInput& input, std::size_t joint, const JointActuation& actuation) noexcept;
  void limit_joint(const SafetyInput& input, std::size_t joint, JointActuation& actuation) noexcept;
  void degrade_joint(std::size_t joint, SafetyLevel level, const Fault& fault) noexcept;

  SafetySettings settings_;
  std::size_t joint_count_;
  std::array<SafetyLevel, max_joints> joint_levels_{};
  SafetyLevel robot_level_ = SafetyLevel::normal;
  std::array<bool, max_joints> limiting_{};
  bool limited_ = false;  // any joint, in this tick
  bool heartbeat_lost_ = false;
  double lost_for_s_ = 0;
  std::uint32_t overruns_in_a_row_ = 0;
  std::uint32_t fault_count_ = 0;
  Fault first_fault_;
  FaultLog log_;
  std::uint32_t level_number_ = 0;
};

}  // namespace kadans
