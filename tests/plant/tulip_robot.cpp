#include "tulip_robot.h"

#include <string>

#include "kadans/model/urdf.h"

namespace kadans::test {
namespace {

double crouch_rad(const std::string& joint) {
  if (joint.ends_with("hip_pitch") || joint.ends_with("ankle_pitch")) return -0.3;
  return joint.ends_with("knee") ? 0.6 : 0;
}

DriveSettings drive_of(const Joint& joint, Drives kind) {
  DriveSettings drive;
  if (joint.passive()) {
    drive.parallel_spring_Nm_per_rad = 25;
    drive.parallel_damping_Nms_per_rad = 0.6;
    return drive;
  }
  drive.torque_max_Nm = joint.effort_max_Nm;
  drive.velocity_max_rad_s = joint.velocity_max_rad_s;
  drive.knee_velocity_rad_s = joint.velocity_max_rad_s / 2;
  drive.rotor_inertia_kg_m2 = 0.02;
  drive.viscous_Nms_per_rad = 0.2;
  if (kind == Drives::rigid) return drive;
  drive.spring_Nm_per_rad = kind == Drives::elastic ? 300 : 3000;
  drive.spring_damping_Nms_per_rad = 0.5;
  return drive;
}

FootSettings foot_of(const std::string& link) {
  const double inner = link.starts_with("l") ? -0.05 : 0.05;
  FootSettings foot;
  foot.link = link;
  foot.sensors_m = {{{-0.08, inner, -0.06}, {-0.08, -inner, -0.06}, {0.14, inner, -0.06}, {0.14, -inner, -0.06}}};
  return foot;
}

}  // namespace

Robot tulip(Drives kind) {
  Robot robot;
  robot.model = read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf");
  for (const Joint& joint : robot.model.joints) {
    robot.settings.drives.push_back(drive_of(joint, kind));
    robot.settings.position_rad.push_back(crouch_rad(joint.name));
  }
  robot.settings.encoders.resize(robot.model.joints.size());
  for (const std::string link : {"l_ankle_roll_link", "r_ankle_roll_link"}) {
    robot.settings.feet.push_back(foot_of(link));
    robot.settings.surfaces.push_back({link, 0.8});
  }
  return robot;
}

void JointHold::act(Plant& plant) {
  plant.read(sensors_);
  actuation_.joint_count = sensors_.joint_count;
  plant.write(actuation_);
  for (std::size_t i = 0; i < sensors_.joint_count; ++i) {
    const double at_rad = sensors_.joints[i].motor_position_rad;
    const double velocity_rad_s = started_ ? (at_rad - last_rad_[i]) / 1e-3 : 0;
    last_rad_[i] = at_rad;
    actuation_.joints[i] = {.effort_Nm = 300 * (target_rad_[i] - at_rad) - 6 * velocity_rad_s,
                            .mode = ActuationMode::effort};
  }
  started_ = true;
}

}  // namespace kadans::test
