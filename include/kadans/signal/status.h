// Robot status: what the control engine knows of the robot as a whole, and the snapshot that it publishes each tick.
// alignas(8) as in frames.h: the layout does not depend on the machine.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "kadans/signal/command.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/joystick.h"
#include "kadans/signal/sight.h"

namespace kadans {

// The degradation ladder: each rung lets the robot do less. Order matters: worse is larger.
enum class SafetyLevel : std::uint8_t { normal, limited, hold, damp, off };
inline constexpr std::size_t safety_levels = 5;
const char* name(SafetyLevel level) noexcept;

// The posture of the trunk: upright, or lying on one of four sides; falling: still upright, but on the way down.
enum class Posture : std::uint8_t { upright, prone, supine, left, right, falling };
inline constexpr std::size_t posture_count = 6;
const char* name(Posture posture) noexcept;

struct alignas(8) BaseStatus {
  Quat orientation{1, 0, 0, 0};
  double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;
  double tilt_rad = 0;            // between the base's z axis and up; >= 0
  Vec3 angular_velocity_rad_s{};  // in the base frame
  double height_m = 0;            // of the base frame over the lowest sole, through the legs; holds when no foot bears
  Posture posture = Posture::upright;
};

struct alignas(8) FootStatus {
  bool contact = false;
  alignas(8) double force_N = 0;    // sum of the foot's sensors
  double cop_x_m = 0, cop_y_m = 0;  // centre of pressure in the foot's frame; holds without contact
};

// How the ground supports the robot, over all feet in contact. In the heading frame: the origin is below the base
// frame's origin, x points forward along the ground where the base points, z up.
struct alignas(8) SupportStatus {
  double force_N = 0;               // sum over the feet in contact; 0 without contact
  double cop_x_m = 0, cop_y_m = 0;  // centre of pressure; holds without contact
};

// Where the base is on the ground since the last reset, by the feet that stood and the gyro (estimate/odometry.h). x
// points where the base pointed at the reset. Robots without feet have none: not valid.
struct alignas(8) OdometryStatus {
  double x_m = 0, y_m = 0, heading_rad = 0;
  std::uint32_t resets = 0;  // since the start; wraps around
  bool valid = false;        // no: it fell or was lifted since the reset
  // The same since the start, whatever was reset: the path along which the world model keeps its places.
  alignas(8) double path_x_m = 0;
  double path_y_m = 0, path_heading_rad = 0;
  std::uint32_t breaks = 0;  // how often `valid` changed; what lies before a change is not where the path says
};

// A fault in brief, for those who look at all new ones.
struct NewFault {
  FaultCode code = FaultCode::none;
  std::uint16_t joint = no_joint;
  alignas(8) double value = 0;
  double limit = 0;
};
inline constexpr std::uint32_t new_faults_shown = 8;

struct SafetyStatus {
  SafetyLevel level = SafetyLevel::normal;
  bool stopped = false;                                 // by the emergency stop, until it is lifted
  std::uint16_t lifts = 0;                              // how often somebody outside cleared all faults; wraps around
  std::uint32_t fault_count = 0;                        // since the start or the last clearing
  Fault first_fault;                                    // kept until cleared
  std::uint64_t faults_raised = 0;                      // since the start
  std::array<NewFault, new_faults_shown> new_faults{};  // the newest; number n is at n modulo new_faults_shown
};

struct alignas(8) RobotStatus {
  BaseStatus base;
  std::uint32_t foot_count = 0;
  std::array<FootStatus, max_feet> feet{};
  SafetyStatus safety;
  SupportStatus support;
  std::uint32_t channel_count = 0;
  std::array<double, max_channels> channels{};  // the last finite readings; NaN before the first
  OdometryStatus odometry;
};

// What the drives and their supply report, as in the sensor frame.
struct DriveStatus {
  float temperature_C = std::numeric_limits<float>::quiet_NaN();
  std::uint32_t code = 0;
  DriveState state = DriveState::enabled;
  bool homed = true, braked = false;
  std::uint8_t reserved = 0;
};

struct alignas(8) PowerStatus {
  double supply_V = std::numeric_limits<double>::quiet_NaN();
  bool emergency = false;
  std::array<DriveStatus, max_joints> drives{};  // by joint
};

// What the behaviors see of a control object.
struct alignas(8) ObjectStatus {
  bool active = false;
  float dwell_s = 0;                         // for how long a switch of it, or of a set with it, is still refused
  alignas(8) double motion_remaining_s = 0;  // until the last of its set-points is reached; 0 at rest
};

// Where a set-point is on its way; NaN where its control object is not active, or cannot be led along a motion.
struct SetpointStatus {
  double value = std::numeric_limits<double>::quiet_NaN();
  double velocity = std::numeric_limits<double>::quiet_NaN();
};

// Control sets, one bit each, in the order of the configuration.
using SetMask = std::uint32_t;
static_assert(max_control_sets <= 32);

// One tick of the control engine as the other threads see it.
struct alignas(8) Snapshot {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;
  std::uint32_t transactions_applied = 0;  // number of the last transaction applied; they are numbered from 1
  std::uint32_t commands_refused = 0;      // not finite, out of range, unknown or too old
  SetMask control_sets = 0;                // those that are active
  std::uint32_t transactions_refused = 0;  // since the start
  JointStates joints;
  RobotStatus status;
  std::uint32_t object_count = 0;
  std::uint32_t setpoint_count = 0;  // of those that are shown
  std::array<ObjectStatus, max_objects> objects{};
  std::array<SetpointStatus, max_setpoints_shown> setpoints{};  // by SetpointId
  std::array<Refusal, refusals_shown> refusals{};               // the newest; number n is at n modulo refusals_shown
  std::array<ArmedStatus, max_armed> armed{};
  JoystickState joystick;
  SeenBall ball;
  SeenEntries seen;
  PowerStatus power;
};

// Numbered entries that `to` has, by their count, stay as they are.
inline void copy_used(const SafetyStatus& from, SafetyStatus& to) noexcept {
  to.level = from.level;
  to.stopped = from.stopped;
  to.lifts = from.lifts;
  to.fault_count = from.fault_count;
  to.first_fault = from.first_fault;
  if (to.faults_raised == from.faults_raised) return;
  to.faults_raised = from.faults_raised;
  to.new_faults = from.new_faults;
}

inline void copy_used(const RobotStatus& from, RobotStatus& to) noexcept {
  to.base = from.base;
  to.foot_count = from.foot_count;
  copy_first(from.feet, from.foot_count, to.feet);
  copy_used(from.safety, to.safety);
  to.support = from.support;
  to.channel_count = from.channel_count;
  copy_first(from.channels, from.channel_count, to.channels);
  to.odometry = from.odometry;
}

inline void copy_used(const Snapshot& from, Snapshot& to) noexcept {
  to.tick = from.tick;
  to.time_ns = from.time_ns;
  to.transactions_applied = from.transactions_applied;
  to.commands_refused = from.commands_refused;
  to.control_sets = from.control_sets;
  if (to.transactions_refused != from.transactions_refused) to.refusals = from.refusals;  // numbered, too
  to.transactions_refused = from.transactions_refused;
  copy_used(from.joints, to.joints);
  copy_used(from.status, to.status);
  to.object_count = from.object_count;
  to.setpoint_count = from.setpoint_count;
  copy_first(from.objects, from.object_count, to.objects);
  copy_first(from.setpoints, from.setpoint_count, to.setpoints);
  to.armed = from.armed;
  to.joystick = from.joystick;
  to.ball = from.ball;
  copy_used(from.seen, to.seen);
  to.power.supply_V = from.power.supply_V;
  to.power.emergency = from.power.emergency;
  copy_first(from.power.drives, from.joints.count, to.power.drives);
}

static_assert(std::is_trivially_copyable_v<Snapshot>);
static_assert(sizeof(BaseStatus) == 104 && sizeof(FootStatus) == 32 &&
              sizeof(SafetyStatus) == 88 + 24 * new_faults_shown && sizeof(ObjectStatus) == 16 &&
              alignof(SafetyStatus) == 8);
static_assert(offsetof(RobotStatus, feet) == 112 && offsetof(Snapshot, joints) == 32);
static_assert(sizeof(DriveStatus) == 12 && sizeof(PowerStatus) == 16 + 12 * max_joints);
static_assert(sizeof(OdometryStatus) == 64 &&
              sizeof(Snapshot) == 5912 + 32 * max_feet + sizeof(SeenBall) + sizeof(SeenEntries) +
                                      24 * new_faults_shown);  // a new field also belongs in copy_used()

}  // namespace kadans
