// What happens in a scenario at given times, so that the run can be repeated: orders of the supervisor, faults and
// pushes.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "config/json/fields.h"
#include "kadans/signal/frames.h"
#include "play_order.h"

namespace kadans {

// An order of the supervisor at a given time. A reload lets a behavior continue with another file, as if somebody had
// saved it.
struct ScenarioEvent {
  double at_s = 0;
  PlayOrder order;
};

// The fields of one event. `folders` are used to find the behaviors of a list. The name of a reload's behavior is not
// checked here, because the names are known only when the behaviors play.
void event_fields(Fields& f, ScenarioEvent& event, const PlayFolders& folders, Problems& problems);

// A fault that a scenario injects: in a sensor, a drive, the supply, the behaviors' tick, the transport of commands, or
// the clock.
struct ScenarioFault {
  enum class Kind : std::uint8_t {
    sensor_silent,
    sensor_stuck,
    sensor_offset,
    sensor_noise,
    sensor_jump,
    sensor_not_finite,
    drive_dead,
    drive_weak,
    drive_stuck,
    drive_offset,
    drive_late,
    drive_tripped,
    drive_disabled,
    drive_hot,
    drive_old,
    supply,
    emergency_button,
    behaviors_silent,
    commands_lost,
    commands_late,
    commands_not_finite,
    clock_missed,
  };
  Kind kind = Kind::sensor_silent;
  // The name of a joint; for a sensor fault also of a foot's link or a sensor, or "imu"; "" for faults of the whole
  // robot.
  PlacedName of;
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();  // not included
  double size = 0;                                           // see the fields' docs

  bool of_sensor() const noexcept { return kind <= Kind::sensor_not_finite; }
  bool of_drive() const noexcept { return kind >= Kind::drive_dead && kind <= Kind::drive_old; }
  bool of_supply() const noexcept { return kind == Kind::supply || kind == Kind::emergency_button; }
};

void fault_fields(Fields& f, ScenarioFault& fault, Problems& problems);

// A push on a link of the robot: a force that acts for a time.
inline constexpr double push_max_Ns = 1e4;  // along each axis

struct ScenarioPush {
  enum class Shape : std::uint8_t { constant, half_sine };
  PlacedName link;
  double at_s = 0;
  double duration_s = 0.1;
  Vec3 impulse_Ns{};  // world axes; the integral of the force
  Vec3 point_m{};     // in the link's frame
  Shape shape = Shape::constant;
};

// The fields of one push, with "impulse_Ns" or "force_N" (its peak).
void push_fields(Fields& f, ScenarioPush& push, Problems& problems);

}  // namespace kadans
