// One servo as the cycle of its port sees it: what is asked of it, what it answered, what is wrong with it.
//
// Its operating mode follows what its joint is asked for: effort and impedance by current (by PWM where it measures no
// current), position by current-based position (by extended position), velocity by velocity. An operating mode can only
// be changed while torque is off, so the joint is without torque for two or three cycles then.
//
// One owner, the thread of the port; nothing allocates or throws.
#pragma once

#include <cstdint>

#include "control_table.h"
#include "kadans/signal/frames.h"
#include "servo_bus.h"
#include "settings.h"

namespace kadans::dynamixel {

// Codes of the frames: the bits of the register Hardware Error Status, or one of these.
inline constexpr std::uint32_t code_silent = 0x100, code_forgot = 0x200, code_refuses = 0x400;
std::string_view drive_code_words(std::uint32_t code) noexcept;

struct ServoReading {
  JointSample joint{.drive = DriveState::off};  // in the drive's coordinate
  double velocity_rad_s = 0;
  double supply_V = std::numeric_limits<double>::quiet_NaN();
};

// Registers that a servo follows, beside its operating mode.
struct ServoGoals {
  std::int16_t pwm = pwm_full, current = 0;
  std::int32_t velocity = 0, position = 0;
  bool torque = false;
};

class Servo {
 public:
  enum class Stage : std::uint8_t { working, rebooting, setting_up, silent };
  enum class SetUp : std::uint8_t { goes_on, done, failed };

  Servo(const ServoSettings& settings, std::size_t joint, double watchdog_s) noexcept;

  std::uint8_t id() const noexcept { return static_cast<std::uint8_t>(settings_.id); }
  std::size_t joint() const noexcept { return joint_; }
  const ServoSettings& settings() const noexcept { return settings_; }
  const ServoModel& model() const noexcept { return *settings_.model; }
  const IndirectLayout& layout() const noexcept { return layout_; }
  Stage stage() const noexcept { return stage_; }
  std::uint8_t watchdog_units() const noexcept { return watchdog_units_; }
  const ServoReading& reading() const noexcept { return reading_; }
  std::uint32_t limited() const noexcept { return limited_; }  // how often a goal was beyond the servo's limits

  // One step of setting it up; it waits for the servo's answer.
  SetUp set_up(ServoBus& bus) noexcept;
  void start_set_up() noexcept;

  // Each cycle: carries out a new order, decides what the servo is to do.
  void plan(const JointActuation& asked, const DriveRequest& order, std::int64_t now_ns) noexcept;
  const ServoGoals& goals() const noexcept { return goals_; }
  // An operating mode that it must be given before it goes on; `unknown`: none.
  OperatingMode wants_mode() const noexcept { return wants_mode_; }
  void has_mode(OperatingMode mode) noexcept {
    read_in_mode_ = read_in_mode_ && mode == mode_;  // its position may count from elsewhere now
    mode_ = mode;
  }
  bool wants_reboot() const noexcept { return wants_reboot_; }
  void rebooted(std::int64_t now_ns) noexcept;

  // What it answered to a cycle's read, `data` as its layout says. False: it is not what a servo that was set up shows.
  bool take(Octets data, std::int64_t time_ns) noexcept;
  void give_up(std::uint32_t code) noexcept;                 // until a reset
  std::uint32_t missed() const noexcept { return missed_; }  // reads without an answer in a row
  void miss() noexcept { ++missed_; }

 private:
  void carry_out(DriveOrder order) noexcept;
  OperatingMode mode_for(ActuationMode mode) const noexcept;
  void aim(const JointActuation& asked) noexcept;
  double effort_of(const JointActuation& asked) const noexcept;
  template <typename T>
  T limit(double value, double most) noexcept;
  void tell_state() noexcept;

  ServoSettings settings_;
  std::size_t joint_;
  IndirectLayout layout_;
  double sign_, Nm_per_unit_;
  std::uint8_t watchdog_units_;

  Stage stage_ = Stage::working;
  unsigned step_ = 0, tries_ = 0;
  std::int64_t reboot_over_ns_ = 0;
  bool disabled_ = false, wants_reboot_ = false;
  std::uint8_t order_seen_ = 0;
  OperatingMode mode_ = OperatingMode::unknown, wants_mode_ = OperatingMode::unknown;
  double pwm_most_ = pwm_full, current_most_ = 0, velocity_most_ = 0;

  ServoGoals goals_;
  ServoReading reading_;
  std::int32_t raw_position_ = 0, turned_ = 0;  // turned_: pulses from its zero, without a jump where it wraps around
  bool placed_ = false, read_in_mode_ = false, has_torque_ = false;
  std::uint32_t missed_ = 0, wrong_torque_ = 0, strange_ = 0, limited_ = 0;
};

}  // namespace kadans::dynamixel
