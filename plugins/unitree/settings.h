// Which motors move which joints, and where the robot is: the fields under plant.unitree of the robot's configuration.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/plant/plant_type.h"
#include "message.h"

namespace unitree {

// A robot that Unitree sells. Its joints have the names of its public URDF, in the order of its motors.
struct RobotKind {
  std::string_view name;
  Family family;
  std::vector<std::string> joints;
};
// nullptr: there is none of this name.
const RobotKind* find_kind(std::string_view name);

struct MotorSettings {
  std::string drive;
  std::uint32_t number = 0;
  double stiffness_Nm_per_rad = 0, damping_Nms_per_rad = 0;  // of the mode position; damping of velocity, too
};

struct Settings {
  const RobotKind* kind = nullptr;  // nullptr: the configuration says nothing of this plant
  std::string interface;            // network card
  std::uint32_t domain = 0;
  bool checksums = true;
  double period_s = 0.002;
  double connect_timeout_s = 5;
  double watchdog_s = 0.1;  // of the emulated robot
  double damping_Nms_per_rad = 2, damping_s = 2;
  double stiffness_of_position_Nm_per_rad = 60, damping_of_position_Nms_per_rad = 2;
  double foot_N_per_count = 0;
  std::vector<MotorSettings> motors;  // that the configuration names

  void fields(kadans::PlantFields& f);
  std::int64_t period_ns() const noexcept { return static_cast<std::int64_t>(1e9 * period_s); }
  // "INTERFACE", "INTERFACE:DOMAIN" or ":DOMAIN" of the command line in place of the configuration's. `option` is for
  // the message. Throws InputError.
  void take_place(const std::string& place, const char* option);
  std::string place() const;  // "domain 0 on eth0"
};

// Where a foot stands in foot_force, by how its name begins: FR or front_right, and so on. feet_max: it has no place.
inline constexpr std::size_t feet_max = 4;
std::size_t place_of_foot(std::string_view name) noexcept;

// The motor of each joint's drive, in the order of the joints. Throws InputError.
std::vector<MotorSettings> motors_of(const Settings& settings, const kadans::PlantSite& site);

}  // namespace unitree
