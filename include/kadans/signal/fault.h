// Fault codes: what went wrong, where and when. A fault names the limit behind it and the key of the robot's
// configuration that sets this limit, so that a person can look it up. safety/ladder.h says what follows from a
// fault, safety/detection.h how soon each is found.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kadans {

// At most 64: the safety layer keeps a bit for each.
enum class FaultCode : std::uint16_t {
  none,
  // Of a joint, or of what a control object wrote for it.
  position_limit,        // passed its limit and the margin
  velocity_limit,        // faster than its limit and the margin
  effort_limit,          // asked for more torque than it may have: limited
  actuation_not_finite,  // asked for NaN or infinity: never written
  sensor_not_finite,     // its sensor delivered NaN or infinity
  sensor_silent,         // its sensor delivered no new reading
  // Of the runtime.
  heartbeat_lost,   // the behavior engine stopped ticking
  tick_overrun,     // a tick of the control engine came late
  command_refused,  // a command was not finite, out of range, unknown, or the robot was held
  // Of a joint again.
  soft_stop,          // pushed into the zone before its position limit: faded out
  soft_speed,         // driven on beyond its speed limit: faded out
  effort_rate_limit,  // its torque was to change faster than it may: limited
  power_limit,        // torque times speed beyond the limit: limited
  motor_warm,         // its winding, by the thermal model, is warm: torque is derated
  motor_hot,          // its winding reached its limit
  sensor_stuck,       // its reading stays exactly the same although the motor moves or pushes
  sensor_jump,        // its reading stepped further than the joint can move
  // Of the inertial measurement unit and the feet.
  imu_silent,
  imu_stuck,
  imu_jump,  // a rate or acceleration beyond what the sensor can measure, or a step in the rate
  imu_not_finite,
  foot_silent,
  foot_stuck,
  foot_jump,  // a force beyond what the sensor can measure
  foot_not_finite,
  // Of the robot.
  tilt,            // leans more than it should
  fall,            // is falling
  impact,          // hit something while falling
  command_old,     // a transaction came too late
  overruns,        // too many late ticks in a row
  joints_lost,     // too many joints damp or are off
  emergency_stop,  // somebody asked for it
  // Of a drive.
  drive_fault,        // reports a fault of its own
  drive_not_enabled,  // is asked for torque, and is off, ready or homing
  drive_hot,          // reports too high a temperature
  sample_old,         // its sample was measured too long ago
  // Of what the drives have in common.
  supply_low,
  supply_high,
  emergency_input,  // somebody presses the emergency stop's button
  // Of a sensor that the configuration names.
  channel_silent,
  channel_range,  // outside what it may read
  channel_not_finite,
  // Of two coupled joints.
  modes_differ,  // asked for two modes at once, which their drives cannot do: never written
};
inline constexpr std::size_t fault_codes = 44;

const char* name(FaultCode code) noexcept;
// The key of the robot's configuration that decides when this is a fault; "" for none.
const char* configuration_key(FaultCode code) noexcept;

inline constexpr std::uint16_t no_joint = 0xffff;

// What a fault's numbers cannot say: who asked for the stop, what the drive's maker calls the code. Ends with a zero.
using FaultWords = std::array<char, 40>;
FaultWords fault_words(std::string_view text) noexcept;  // cut where it is longer

// The maker's words for a drive's code; "" for an unknown code. Any thread, at any time.
using DriveWords = std::string_view (*)(std::uint32_t code) noexcept;

struct Fault {
  FaultCode code = FaultCode::none;
  std::uint16_t joint = no_joint;     // index in the model (a foot's: the joint that carries it), or no_joint
  std::uint16_t robot = 0;            // the number in the world of who has it; safety counts only its own
  alignas(8) std::uint64_t tick = 0;  // of the control engine
  double value = 0;                   // what was seen
  double limit = 0;                   // what was allowed
  FaultWords words{};                 // instead of value and limit, for faults that have none
};
static_assert(sizeof(Fault) == 72 && alignof(Fault) == 8 && offsetof(Fault, tick) == 8, "the same on 32-bit machines");

// A fault as people and programs are told of it, with its names: whatever shows one, live or from a record, shows this.
struct ToldFault {
  std::string name, joint;      // joint: "" for none; of a further robot with its name: "left.l_knee", "left"
  double value = 0, limit = 0;  // as in Fault
  std::string words;            // in place of the two, where there are some
  std::int64_t time_ns = 0;     // where it is known
};
// `robot`: the name of a further robot of the world.
ToldFault told(const Fault& fault, const std::string& joint = "", std::int64_t time_ns = 0,
               const std::string& robot = "");
// "motor_hot of l_knee"
std::string fault_name(const ToldFault& fault);
// "121, limit 120", or its words
std::string fault_detail(const ToldFault& fault);
// "motor_hot of l_knee: 121, limit 120"
std::string fault_text(const ToldFault& fault);

}  // namespace kadans
