// A robot of two motors on an ideal plant with everything around it that the control engine needs.
#pragma once

#include <memory>
#include <utility>

#include "control/made_objects.h"
#include "engine/behavior_engine.h"
#include "engine/lockstep.h"
#include "engine/tick/control_engine.h"
#include "estimate/estimator.h"
#include "kadans/plant/ideal_world.h"

namespace kadans::bench {

inline Joint joint(const char* name, std::size_t parent) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.lower_rad = -2;
  joint.upper_rad = 2;
  joint.effort_max_Nm = 20;
  joint.velocity_max_rad_s = 10;
  return joint;
}

inline RobotModel robot() {
  RobotModel model;
  model.name = "bench";
  model.links.resize(3);
  model.joints = {joint("hip", 0), joint("knee", 1)};
  return model;
}

inline PlantSettings plant_settings() {
  PlantSettings settings;
  settings.drives.resize(2);
  for (DriveSettings& drive : settings.drives) drive = {.torque_max_Nm = 20, .rotor_inertia_kg_m2 = 0.1};
  settings.encoders.resize(2);
  settings.position_rad = {0.1, -0.2};
  return settings;
}

inline SafetySettings safety_settings() {
  SafetySettings settings;
  settings.joints.assign(2, {.lower_rad = -2, .upper_rad = 2, .velocity_max_rad_s = 10, .effort_max_Nm = 20});
  return settings;
}

inline std::vector<std::unique_ptr<ControlObject>> posture(Catalog& catalog, const RobotModel& model,
                                                           std::unique_ptr<ControlObject> at_drives = nullptr) {
  std::vector<std::unique_ptr<ControlObject>> objects;
  const auto add = [&](const char* name, std::unique_ptr<ControlObject> object) {
    Declaration declaration(name, static_cast<std::uint32_t>(objects.size()), catalog.parameters, catalog.setpoints,
                            catalog.signals);
    object->declare(declaration);
    objects.push_back(std::move(object));
    catalog.objects.push_back({.name = name, .joints = {0, 1}});
  };
  for (const char* name : {"posture", "spare"}) add(name, make_joint_pid(ObjectSetup{model, {0, 1}}));
  if (at_drives) {
    add("drives", std::move(at_drives));
    catalog.at_drives = {2};
  }
  catalog.model = &model;
  catalog.sets = {{"posture", {0}}, {"spare", {1}}};
  for (const std::string& parameter : catalog.parameters.names()) {
    const ParameterId id = catalog.parameters.find(parameter).value();
    if (parameter.ends_with("kp_Nm_per_rad")) (void)catalog.parameters.set(id, 40);
    if (parameter.ends_with("kd_Nms_per_rad")) (void)catalog.parameters.set(id, 4);
    if (parameter.ends_with("damping_ratio")) (void)catalog.parameters.set(id, 0);  // of a spring the plant has not
  }
  return objects;
}

struct Robot {
  Robot() = default;
  explicit Robot(std::unique_ptr<ControlObject> object) : at_drives(std::move(object)) {}

  std::unique_ptr<ControlObject> at_drives;
  EngineSettings settings;
  RobotModel model = robot();
  IdealWorld plant{model, plant_settings()};
  Catalog catalog;
  Estimator estimator{model, {}, 0.001};
  Safety safety{safety_settings(), model};
  std::vector<std::unique_ptr<ControlObject>> objects = posture(catalog, model, std::move(at_drives));
  ControlSets sets{catalog, std::move(objects)};
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  ControlEngine control{settings, plant, estimator, safety, sets, catalog, *exchange};
  BehaviorEngine behaviors{sets, *exchange, nullptr};
  Lockstep lockstep{settings, plant, control, behaviors};

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) lockstep.step();
  }
  double position_rad(std::size_t joint) const { return plant.truth().position_rad[joint]; }
};

}  // namespace kadans::bench
