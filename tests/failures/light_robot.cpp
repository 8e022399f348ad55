#include "light_robot.h"

#include <algorithm>
#include <utility>

#include "control/made_objects.h"

namespace kadans::failures {
namespace {

constexpr double effort_max_Nm = 20;

RobotModel make_model(std::vector<Transmission> transmissions) {
  RobotModel model;
  model.transmissions = std::move(transmissions);
  model.name = "light";
  model.links.resize(joints + 1);
  const char* names[] = {"l_hip", "l_ankle", "r_hip", "r_ankle"};
  for (std::size_t i = 0; i < joints; ++i) {
    Joint& joint = model.joints.emplace_back();
    joint.name = names[i];
    joint.parent = i % 2 == 0 ? 0 : i;
    joint.axis = {0, 1, 0};
    joint.lower_rad = -1.5;
    joint.upper_rad = 1.5;
    joint.effort_max_Nm = effort_max_Nm;
    joint.velocity_max_rad_s = 10;
    model.links[i + 1].name = joint.name + "_link";
  }
  return model;
}

// A distance ahead, read in every 20th tick.
std::vector<SensorChannel> channels() {
  return {
      {.name = "front", .unit = "m", .doc = "Distance ahead.", .min = 0.1, .max = 4, .period_s = 0.02, .value = 1.5}};
}

PlantSettings plant_settings() {
  PlantSettings settings;
  settings.drives.assign(joints, {.torque_max_Nm = effort_max_Nm, .rotor_inertia_kg_m2 = 0.1});
  settings.encoders.resize(joints);
  settings.position_rad = {0.1, -0.2, 0.3, -0.1};
  settings.channels = channels();
  return settings;
}

EstimateSettings estimate_settings() {
  EstimateSettings settings;
  settings.channels = channels();
  for (const char* link : {"l_ankle_link", "r_ankle_link"}) {
    settings.feet.push_back({link, {{{-0.1, -0.05, 0}, {-0.1, 0.05, 0}, {0.1, -0.05, 0}, {0.1, 0.05, 0}}}});
  }
  return settings;
}

SafetySettings safety_settings(const Reactions& reactions) {
  SafetySettings settings;
  settings.joints.assign(
      joints, {.lower_rad = -1.5, .upper_rad = 1.5, .velocity_max_rad_s = 10, .effort_max_Nm = effort_max_Nm});
  settings.joints[1].effort_rate_max_Nm_s = 4000;
  settings.joints[2].power_max_W = 150;
  settings.foot_joints = {1, 3};
  settings.channels = channels();
  settings.supply = {.lowest_V = 20, .highest_V = 30};
  settings.drive_words = [](std::uint32_t code) noexcept { return std::string_view(code == 18 ? "undervoltage" : ""); };
  settings.reactions = reactions;
  return settings;
}

double servo_Nm(const JointActuation& asked, double position_rad, double velocity_rad_s) {
  constexpr double position_gain_Nm_per_rad = 100, velocity_gain_Nms_per_rad = 6;
  const bool by_asked = asked.mode == ActuationMode::impedance;
  double effort_Nm = asked.effort_Nm + (by_asked ? asked.damping_Nms_per_rad : velocity_gain_Nms_per_rad) *
                                           (asked.velocity_rad_s - velocity_rad_s);
  if (has_position(asked.mode)) {
    effort_Nm +=
        (by_asked ? asked.stiffness_Nm_per_rad : position_gain_Nm_per_rad) * (asked.position_rad - position_rad);
  }
  return std::clamp(effort_Nm, -effort_max_Nm, effort_max_Nm);
}

}  // namespace

void NoisyPlant::read(SensorFrame& sensors) noexcept {
  ideal_.read(sensors);
  sensors.foot_count = 2;
  sensors.supply_V = 24;
  for (double& rate_rad_s : sensors.imu.angular_velocity_rad_s) rate_rad_s += random_.uniform(-0.01, 0.01);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    for (double& force_N : sensors.feet[foot].force_N) force_N = 20 + random_.uniform(-0.5, 0.5);
    sensors.feet[foot].sequence = sensors.imu.sequence;
  }
  for (std::size_t i = 0; i < joints; ++i) sensors.joints[i].position_rad += random_.uniform(-1e-5, 1e-5);
}

void NoisyPlant::write(const ActuationFrame& actuation) noexcept {
  ActuationFrame torques = actuation;
  for (std::size_t i = 0; i < joints; ++i) {
    JointActuation& asked = torques.joints[i];
    if (asked.mode == ActuationMode::effort || asked.mode == ActuationMode::off) continue;
    const double effort_Nm = servo_Nm(asked, truth().position_rad[i], truth().velocity_rad_s[i]);
    asked = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  }
  ideal_.write(torques);
}

LightParts::LightParts(std::uint64_t seed, std::vector<Transmission> transmissions)
    : light_model(make_model(std::move(transmissions))), sound(light_model, plant_settings(), seed) {}

std::vector<std::unique_ptr<ControlObject>> LightParts::objects() {
  Catalog& catalog = light_catalog;
  std::vector<std::unique_ptr<ControlObject>> all;
  all.push_back(make_joint_pid(ObjectSetup{light_model, {0, 1, 2, 3}}));
  Declaration declaration("posture", 0, catalog.parameters, catalog.setpoints, catalog.signals);
  all[0]->declare(declaration);
  catalog.model = &light_model;
  catalog.objects = {{.name = "posture", .type = "joint_pid", .joints = {0, 1, 2, 3}}};
  for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) catalog.objects[0].setpoints.push_back(id);
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id) catalog.objects[0].parameters.push_back(id);
  catalog.sets = {{"posture", {0}}};
  catalog.poses = {{"there", {{0, 0.4}, {1, 0.3}, {2, -0.2}, {3, 0.4}}}, {"safe", {{0, 0}, {1, 0}, {2, 0}, {3, 0}}}};
  for (const std::string& parameter : catalog.parameters.names()) {
    const ParameterId id = catalog.parameters.find(parameter).value();
    if (parameter.ends_with("kp_Nm_per_rad")) (void)catalog.parameters.set(id, 40);
    if (parameter.ends_with("kd_Nms_per_rad")) (void)catalog.parameters.set(id, 4);
  }
  return all;
}

LightRobot::LightRobot(std::uint64_t seed, const Reactions& reactions, std::vector<Transmission> transmissions)
    : LightParts(seed, std::move(transmissions)),
      Rig({.model = light_model,
           .plant = sound,
           .catalog = light_catalog,
           .objects = objects(),
           .estimate = estimate_settings(),
           .safety = safety_settings(reactions),
           .seed = seed}) {}

}  // namespace kadans::failures
