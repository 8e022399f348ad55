#include "light_robot.h"

namespace kadans::failures {
namespace {

constexpr double tolerance = 1e-9;  // of a limit, for rounding

RobotModel make_model() {
  RobotModel model;
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
    joint.effort_max_Nm = 20;
    joint.velocity_max_rad_s = 10;
    model.links[i + 1].name = joint.name + "_link";
  }
  return model;
}

PlantSettings plant_settings() {
  PlantSettings settings;
  settings.drives.assign(joints, {.torque_max_Nm = 20, .rotor_inertia_kg_m2 = 0.1});
  settings.encoders.resize(joints);
  settings.position_rad = {0.1, -0.2, 0.3, -0.1};
  return settings;
}

EstimateSettings estimate_settings() {
  EstimateSettings settings;
  for (const char* link : {"l_ankle_link", "r_ankle_link"}) {
    settings.feet.push_back({link, {{{-0.1, -0.05, 0}, {-0.1, 0.05, 0}, {0.1, -0.05, 0}, {0.1, 0.05, 0}}}});
  }
  return settings;
}

SafetySettings safety_settings() {
  SafetySettings settings;
  settings.joints.assign(joints, {.lower_rad = -1.5, .upper_rad = 1.5, .velocity_max_rad_s = 10, .effort_max_Nm = 20});
  settings.foot_joints = {1, 3};
  return settings;
}

}  // namespace

void NoisyPlant::read(SensorFrame& sensors) noexcept {
  ideal_.read(sensors);
  sensors.foot_count = 2;
  for (double& rate_rad_s : sensors.imu.angular_velocity_rad_s) rate_rad_s += random_.uniform(-0.01, 0.01);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    for (double& force_N : sensors.feet[foot].force_N) force_N = 20 + random_.uniform(-0.5, 0.5);
    sensors.feet[foot].sequence = sensors.imu.sequence;
  }
  for (std::size_t i = 0; i < joints; ++i) sensors.joints[i].position_rad += random_.uniform(-1e-5, 1e-5);
}

std::vector<std::unique_ptr<ControlObject>> LightRobot::objects() {
  auto object = std::make_unique<Saboteur>(ObjectSetup{model, {0, 1, 2, 3}});
  saboteur = object.get();
  Declaration declaration("posture", 0, catalog.parameters, catalog.setpoints, catalog.signals);
  object->declare(declaration);
  catalog.model = &model;
  catalog.objects = {{.name = "posture", .type = "joint_pid", .joints = {0, 1, 2, 3}}};
  for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) catalog.objects[0].setpoints.push_back(id);
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id) catalog.objects[0].parameters.push_back(id);
  catalog.sets = {{"posture", {0}}};
  for (const std::string& parameter : catalog.parameters.names()) {
    const ParameterId id = catalog.parameters.find(parameter).value();
    if (parameter.ends_with("kp_Nm_per_rad")) (void)catalog.parameters.set(id, 40);
    if (parameter.ends_with("kd_Nms_per_rad")) (void)catalog.parameters.set(id, 4);
  }
  std::vector<std::unique_ptr<ControlObject>> all;
  all.push_back(std::move(object));
  return all;
}

LightRobot::LightRobot(std::uint64_t seed, BehaviorHost* host)
    : model(make_model()),
      sound(model, plant_settings(), seed),
      plant(sound, seed),
      sets(catalog, objects()),
      estimator(model, estimate_settings(), 1e-9 * static_cast<double>(period_ns)),
      safety(safety_settings(), model),
      control(settings, plant, estimator, safety, sets, catalog, *exchange),
      behaviors(sets, *exchange, host),
      sender(exchange->commands) {
  for (const Joint& joint : model.joints) {
    written_.push_back(catalog.signals.find("actuation." + joint.name + ".effort_Nm").value());
  }
}

void LightRobot::send(const Command& command, std::int64_t age_ns) {
  sender.begin(time_ns - age_ns);
  (void)sender.add(command);
  (void)sender.commit();
}

void LightRobot::tick(std::int64_t dt_ns, std::uint32_t missed) {
  if (control.ticks() > 0) {
    plant.step(dt_ns);
    time_ns += dt_ns;
  }
  control.tick(time_ns, 1e-9 * static_cast<double>(dt_ns), missed);
  look_at_what_was_written();
  Fault fault;
  while (safety.log().try_pop(fault)) faults.push_back(fault);
  if (behaviors_alive && control.ticks() % 10 == 1) behaviors.tick(time_ns);
}

void LightRobot::look_at_what_was_written() {
  if (!broken_promise.empty()) return;
  for (std::size_t i = 0; i < joints; ++i) {
    const double written_Nm = control.row()[written_[i]];
    const JointState& state = control.state().joints.joints[i];
    const JointLimits& most = limits().joints[i];
    const std::string where = " of " + model.joints[i].name + " in tick " + std::to_string(ticks() - 1);
    const double power_W = std::abs(written_Nm * state.velocity_rad_s);
    if (!std::isfinite(written_Nm)) broken_promise = "not finite" + where;
    if (!(std::abs(written_Nm) <= most.effort_max_Nm + tolerance)) broken_promise = "too much torque" + where;
    if (!(power_W <= most.effort_max_Nm * most.velocity_max_rad_s + tolerance))
      broken_promise = "too much power" + where;
    const bool pushes_on = std::abs(state.position_rad) > 1.5 && written_Nm * state.position_rad > tolerance;
    const bool damping = safety.joint_level(i) >= SafetyLevel::damp;
    if (pushes_on && !damping) broken_promise = "pushes into its stop" + where;
  }
}

std::int64_t LightRobot::first(FaultCode code) const {
  for (const Fault& fault : faults) {
    if (fault.code == code) return static_cast<std::int64_t>(fault.tick);
  }
  return -1;
}

}  // namespace kadans::failures
