// A fault that a scenario injects: in a sensor, a drive, the supply, the behaviors' tick, the transport of commands, or
// the clock.
#pragma once

#include <limits>
#include <string>

#include "config/json/fields.h"

namespace kadans {

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

}  // namespace kadans
