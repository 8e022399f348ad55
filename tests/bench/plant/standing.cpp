#include "standing.h"

#include <algorithm>

#include "kadans/model/urdf.h"
#include "kadans/plant/bullet/bullet_world.h"

namespace kadans::bench {
namespace {

double hold_rad(const std::string& joint, double depth) {
  if (joint.ends_with("hip_pitch") || joint.ends_with("ankle_pitch")) return -0.15 - 0.48 * depth;
  if (joint.ends_with("knee")) return 0.3 + 0.96 * depth;
  return joint.ends_with("shoulder_pitch") ? -0.2 : 0;
}

DriveSettings rigid_drive(const Joint& joint) {
  if (joint.passive()) return {.parallel_spring_Nm_per_rad = 25, .parallel_damping_Nms_per_rad = 0.6};
  return {.torque_max_Nm = joint.effort_max_Nm, .rotor_inertia_kg_m2 = 0.02, .viscous_Nms_per_rad = 0.2};
}

FootSettings foot(const std::string& link) {
  const double inner = link.starts_with("l") ? -0.05 : 0.05;
  FootSettings foot{.link = link, .noise_N = 0.5};
  foot.sensors_m = {{{-0.08, inner, -0.06}, {-0.08, -inner, -0.06}, {0.14, inner, -0.06}, {0.14, -inner, -0.06}}};
  return foot;
}

}  // namespace

PlantSettings standing_settings(const RobotModel& model) {
  PlantSettings settings;
  for (const Joint& joint : model.joints) {
    settings.drives.push_back(rigid_drive(joint));
    settings.position_rad.push_back(hold_rad(joint.name, 0));
    settings.encoders.push_back({9.587379924285257e-05, 2e-05});
  }
  settings.imu.gyro_noise_rad_s = 0.005;
  settings.imu.accelerometer_noise_m_s2 = 0.05;
  for (const std::string link : {"l_ankle_roll_link", "r_ankle_roll_link"}) settings.feet.push_back(foot(link));
  for (const Link& link : model.links) settings.surfaces.push_back({link.name, 0.8});
  return settings;
}

void put_on_ground(const RobotModel& model, PlantSettings& settings) {
  settings.base = BulletWorld(model, settings, 1).truth().base;
  settings.stand_on_ground = false;
}

StandingRobot standing_tulip() {
  StandingRobot robot{read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf"), {}};
  robot.settings = standing_settings(robot.model);
  put_on_ground(robot.model, robot.settings);
  return robot;
}

std::vector<double> hold_torques(const RobotModel& model, const EngineState& state, double depth) {
  std::vector<double> torques;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const double error_rad = hold_rad(joint.name, depth) - state.position_rad[i];
    const double torque_Nm = 300 * error_rad - 4 * state.velocity_rad_s[i];
    torques.push_back(std::clamp(torque_Nm, -joint.effort_max_Nm, joint.effort_max_Nm));
  }
  return torques;
}

}  // namespace kadans::bench
