#include "settings.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "kadans/model/transmission.h"
#include "kadans/signal/input_error.h"

namespace unitree {
namespace {

using kadans::InputError;

using Names = std::vector<std::string>;

// "left_hip_yaw_joint": each of the joints of each limb.
void add_joints(Names& all, const Names& limbs, const Names& joints) {
  for (const std::string& limb : limbs) {
    for (const std::string& joint : joints) all.push_back(limb + joint + "_joint");
  }
}

Names four_legs() {
  Names all;
  add_joints(all, {"FR_", "FL_", "RR_", "RL_"}, {"hip", "thigh", "calf"});
  return all;
}

Names humanoid(const Names& leg, const Names& trunk) {
  Names all;
  add_joints(all, {"left_", "right_"}, leg);
  add_joints(all, {""}, trunk);
  add_joints(all, {"left_", "right_"},
             {"shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "wrist_roll", "wrist_pitch", "wrist_yaw"});
  return all;
}

const std::vector<RobotKind>& kinds() {
  static const std::vector<RobotKind> all{
      {"go2", Family::go, four_legs()},
      {"b2", Family::go, four_legs()},
      {"g1", Family::hg,
       humanoid({"hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch", "ankle_roll"},
                {"waist_yaw", "waist_roll", "waist_pitch"})},
      {"h1_2", Family::hg,
       humanoid({"hip_yaw", "hip_pitch", "hip_roll", "knee", "ankle_pitch", "ankle_roll"}, {"torso"})},
  };
  return all;
}

std::string names_of_kinds() {
  std::string names;
  for (const RobotKind& kind : kinds()) names.append(names.empty() ? "" : ", ").append(kind.name);
  return names;
}

}  // namespace

const RobotKind* find_kind(std::string_view name) {
  const auto found = std::ranges::find(kinds(), name, &RobotKind::name);
  return found == kinds().end() ? nullptr : &*found;
}

void Settings::fields(kadans::PlantFields& f) {
  std::string robot;
  f.string("robot", robot, "what it is: " + names_of_kinds());
  f.string("interface", interface,
           "network card that leads to the robot, such as eth0; default: what CYCLONEDDS_URI says, else this machine "
           "alone");
  f.integer("domain", domain, {0, 230, ""}, "DDS domain");
  f.number("period_s", period_s, {1e-3, 0.02, "s"}, "period at which commands are sent");
  f.boolean("checksums", checksums, "a state whose checksum is wrong is not used");
  f.number("connect_timeout_s", connect_timeout_s, {0.1, 600, "s"}, "time to wait for the robot's first state");
  f.number("damping_s", damping_s, {0, 60, "s"}, "time for which the motors damp at the end, before they are released");
  f.number("damping_Nms_per_rad", damping_Nms_per_rad, {0, 100, "Nm s/rad"},
           "of motors that damp: at the end, and in the emulated robot when it hears nothing");
  f.number("stiffness_of_position_Nm_per_rad", stiffness_of_position_Nm_per_rad, {0, 2000, "Nm/rad"},
           "kp of joints in the mode position");
  f.number("damping_of_position_Nms_per_rad", damping_of_position_Nms_per_rad, {0, 100, "Nm s/rad"},
           "kd of joints in the modes position and velocity");
  f.number("foot_N_per_count", foot_N_per_count, {0, 100, "N"},
           "what a count of foot_force is, shared among the foot's corners; 0: they are not used");
  f.number("watchdog_s", watchdog_s, {1e-3, 10, "s"}, "time without a command after which the emulated robot damps");
  f.map(
      "motors",
      [&](kadans::PlantFields& entry, const std::string& key) {
        MotorSettings motor{.drive = key,
                            .number = motors_max,
                            .stiffness_Nm_per_rad = stiffness_of_position_Nm_per_rad,
                            .damping_Nms_per_rad = damping_of_position_Nms_per_rad};
        entry.integer("number", motor.number, {0, motors_max, ""}, "its place in the messages; default: by its name");
        entry.number("stiffness_Nm_per_rad", motor.stiffness_Nm_per_rad, {0, 2000, "Nm/rad"},
                     "its kp in the mode position");
        entry.number("damping_Nms_per_rad", motor.damping_Nms_per_rad, {0, 100, "Nm s/rad"},
                     "its kd in the modes position and velocity");
        if (!entry.reading()) return;
        const std::span<const std::string> drives = f.drives();
        if (!drives.empty() && std::ranges::find(drives, key) == drives.end())
          entry.refuse("", "the robot has no drive '" + key + "'");
        motors.push_back(motor);
      },
      "motors whose drives have other names than in the robot's public URDF, or gains of their own");
  if (!f.reading() || robot.empty()) return;
  kind = find_kind(robot);
  if (kind == nullptr) f.refuse("robot", "unknown robot '" + robot + "'; there are " + names_of_kinds());
}

void Settings::take_place(const std::string& place, const char* option) {
  if (place.empty()) return;
  const std::size_t colon = std::min(place.find(':'), place.size());
  if (colon > 0) interface = place.substr(0, colon);
  if (colon == place.size()) return;
  const char* const end = place.data() + place.size();
  const auto [rest, error] = std::from_chars(place.data() + colon + 1, end, domain);
  if (error != std::errc() || rest != end || domain > 230)
    throw InputError({.file = option,
                      .message = "'" + place +
                                 "' is no place of a unitree robot: it must be like eth0, eth0:0 or :1, a "
                                 "network card and a DDS domain of 0..230"});
}

std::string Settings::place() const {
  return "DDS domain " + std::to_string(domain) + (interface.empty() ? "" : " on " + interface);
}

std::size_t place_of_foot(std::string_view name) noexcept {
  constexpr std::array<std::array<std::string_view, 2>, feet_max> legs{
      {{"FR", "front_right"}, {"FL", "front_left"}, {"RR", "rear_right"}, {"RL", "rear_left"}}};
  std::size_t place = 0;
  while (place < feet_max && !name.starts_with(legs[place][0]) && !name.starts_with(legs[place][1])) ++place;
  return place;
}

std::vector<MotorSettings> motors_of(const Settings& settings, const kadans::PlantSite& site) {
  const auto fail = [&](const std::string& why) { throw InputError({.file = site.file, .message = why}); };
  if (settings.kind == nullptr) fail("says no plant.unitree.robot, such as go2 (docs/unitree.md)");
  const RobotKind& kind = *settings.kind;
  std::vector<MotorSettings> motors;
  std::set<std::uint32_t> taken;
  for (const std::string& drive : kadans::drive_names(site.layout.joints, site.transmissions)) {
    MotorSettings motor{.drive = drive,
                        .number = motors_max,
                        .stiffness_Nm_per_rad = settings.stiffness_of_position_Nm_per_rad,
                        .damping_Nms_per_rad = settings.damping_of_position_Nms_per_rad};
    const auto given = std::ranges::find(settings.motors, drive, &MotorSettings::drive);
    if (given != settings.motors.end()) motor = *given;
    if (motor.number == motors_max)
      motor.number = static_cast<std::uint32_t>(std::ranges::find(kind.joints, drive) - kind.joints.begin());
    const bool named = given != settings.motors.end() && given->number != motors_max;
    if (!named && motor.number == kind.joints.size())
      fail("drive '" + drive + "' is no motor of a " + std::string(kind.name) + ", such as " + kind.joints[0] +
           ": say its number in plant.unitree.motors");
    if (motor.number >= motors_of(kind.family))
      fail("plant.unitree.motors." + drive + ": a " + std::string(kind.name) + " has motors 0.." +
           std::to_string(motors_of(kind.family) - 1));
    if (!taken.insert(motor.number).second)
      fail("plant.unitree.motors." + drive + ": motor " + std::to_string(motor.number) +
           " moves another drive already");
    motors.push_back(motor);
  }
  return motors;
}

}  // namespace unitree
