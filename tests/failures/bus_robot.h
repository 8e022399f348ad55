// The robot of engine/bench.h on a bus, on virtual time: for rows of the failure contract. The hip is led to 0.5 rad.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "engine/bench.h"
#include "kadans/plant/plant_type.h"

namespace kadans::bus {

inline constexpr std::int64_t tick_ns = 1'000'000;

inline PlantSite site() { return {.file = "robot.json", .layout = {.robot = "bench", .joints = {"hip", "knee"}}}; }

template <typename DrivenWorld>
struct BusRobot {
  DrivenWorld world;
  EngineSettings settings;
  RobotModel model = bench::robot();
  Catalog catalog;
  Estimator estimator{model, {}, 0.001};
  Safety safety;
  std::vector<std::unique_ptr<ControlObject>> objects = bench::posture(catalog, model);
  ControlSets sets{catalog, std::move(objects)};
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  ControlEngine control{settings, world, estimator, safety, sets, catalog, *exchange};
  BehaviorEngine behaviors{sets, *exchange, nullptr};
  std::int64_t time_ns = 0;
  double effort_max_Nm = 0;

  template <typename... Parts>
  BusRobot(DriveWords words, double lowest_V, Parts&&... parts)
      : world(std::make_unique<IdealWorld>(bench::robot(), bench::plant_settings()), parts...),
        safety(watched(words, lowest_V), model) {
    run(20);
    const SetpointId hip = catalog.setpoints.find("posture.hip.position_rad").value();
    CommandSender& sender = behaviors.sender();
    sender.begin(time_ns);
    REQUIRE(sender.add({.kind = CommandKind::set_point, .index = hip, .value = 0.5, .duration_s = 1}));
    REQUIRE(sender.commit());
    run(200);
    REQUIRE(status().level == SafetyLevel::normal);
    REQUIRE(status().fault_count == 0);
  }
  static SafetySettings watched(DriveWords words, double lowest_V) {
    SafetySettings is = bench::safety_settings();
    is.drive_words = words;
    is.silent_ticks_max = 60;  // here the drives shall be told of, not their sensors
    is.supply.lowest_V = lowest_V;
    is.supply.highest_V = lowest_V > 0 ? lowest_V + 20 : 0;
    return is;
  }
  void run(int ticks, bool driven = true) {
    for (int i = 0; i < ticks; ++i, time_ns += tick_ns) {
      if (driven) control.tick(time_ns, 0.001, 0);
      if (driven && time_ns % (10 * tick_ns) == 0) behaviors.tick(time_ns);
      world.step(tick_ns);
      for (std::size_t k = 0; k < 2; ++k)
        effort_max_Nm = std::max(effort_max_Nm, std::abs(world.truth().motor_torque_Nm[k]));
    }
  }
  const SafetyStatus& status() const { return control.state().status.safety; }
  double hip_rad() const { return world.truth().position_rad[0]; }
  // The hip alone is off for this reason; the knee goes on.
  void check_hip_alone(FaultCode code) {
    CHECK(safety.joint_level(0) == SafetyLevel::off);
    CHECK(safety.joint_level(1) == SafetyLevel::normal);
    CHECK(status().first_fault.code == code);
    CHECK(status().first_fault.joint == 0);
    const double at_rad = world.truth().position_rad[1];
    run(300);
    CHECK(safety.joint_level(0) == SafetyLevel::off);
    CHECK(std::abs(world.truth().position_rad[1] - at_rad) < 0.02);
    CHECK(world.truth().motor_torque_Nm[0] == 0);
  }
};

}  // namespace kadans::bus
