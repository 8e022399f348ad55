// TULip squats while its control set is switched every second: PID, computed torque, impedance, PID ...
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/assembly/assembly.h"
#include "app/program.h"

using namespace kadans;

namespace {

using Json = nlohmann::ordered_json;

// The shipped robot with two more control objects on the same joints.
std::filesystem::path robot_with_three_objects() {
  const auto project = program::project_copy("squat_switching");
  const auto file = project / "config/tulip/robot.json";
  Json robot = Json::parse(program::read(file));
  robot["control"]["objects"].push_back(
      {{"name", "computed"},
       {"type", "computed_torque"},
       {"joints", {"*"}},
       {"parameters",
        {{"*.kp_per_s2", 2000},
         {"*.kd_per_s", 40},
         // Little inertia of its own, but the whole robot stands on it, and its sway must die out.
         {"*_ankle_pitch.kp_per_s2", 14000},
         {"*_ankle_pitch.kd_per_s", 900},
         {"*.ki_Nm_per_rads", 300},
         {"*.rotor_inertia_kg_m2", 0.02}}}});
  robot["control"]["objects"].push_back({{"name", "impedance"},
                                         {"type", "joint_impedance"},
                                         {"joints", {"*"}},
                                         {"parameters",
                                          {{"*.stiffness_Nm_per_rad", 350},
                                           {"*.damping_Nms_per_rad", 5},
                                           {"*_ankle_*.damping_Nms_per_rad", 15},
                                           {"*_hip_yaw.stiffness_Nm_per_rad", 100},
                                           {"*_hip_yaw.damping_Nms_per_rad", 2},
                                           {"*_shoulder_pitch.stiffness_Nm_per_rad", 40},
                                           {"*_shoulder_pitch.damping_Nms_per_rad", 1}}}});
  const Json posture = robot["control"]["sets"]["posture"];
  robot["control"]["sets"] = {{"posture", posture}};
  for (const char* name : {"computed", "impedance"}) robot["control"]["sets"][name] = {{"objects", {name}}};
  program::write(file, robot.dump(2));
  return project / "config/scenarios/squat.json";
}

// Commands the squat and the switches from outside, between ticks.
class Switcher final : public RunObserver {
 public:
  Switcher(const Catalog& catalog, EngineExchange& exchange) : catalog_(catalog), sender_(exchange.commands) {}

  void tick(double time_s, std::span<const double> row) override {
    const auto ms = static_cast<int>(std::lround(time_s * 1000));
    if (ms >= 1500) worst_m = std::max(worst_m, std::abs(row[error_]));
    lowest_m = std::min(lowest_m, row[height_]);
    if (ms % 500 != 0) return;
    sender_.begin(static_cast<std::int64_t>(ms) * 1'000'000);
    if (ms % 1000 == 0 && ms > 0) {
      set_ = (set_ + 1) % catalog_.sets.size();
      ++switches;
      REQUIRE(sender_.add({.kind = CommandKind::switch_set, .index = static_cast<std::uint32_t>(set_)}));
    }
    move(ms);
    REQUIRE(sender_.commit() > 0);
  }

  double worst_m = 0, lowest_m = 1;
  int switches = 0;

 private:
  // Down in 1.5 s, a second below, up in 1.5 s, a second above; each new control set is told what is left of the way.
  void move(int ms) {
    const int phase = ms < 1000 ? 4999 : (ms - 1000) % 5000;
    const bool down = phase < 2500;
    const double left_s = std::max(0.5, 1.5 - (down ? phase : phase - 2500) * 1e-3);
    for (const PoseInfo& pose : catalog_.poses) {
      if (pose.name != (down ? "squat" : "stand")) continue;
      for (const auto& [joint, position_rad] : pose.position_rad) {
        const auto id = catalog_.setpoints.find(catalog_.sets[set_].name + "." + catalog_.model->joints[joint].name +
                                                ".position_rad");
        if (!id) continue;
        REQUIRE(
            sender_.add({.kind = CommandKind::set_point, .index = *id, .value = position_rad, .duration_s = left_s}));
      }
    }
  }

  const Catalog& catalog_;
  CommandSender sender_;
  std::size_t set_ = 0;
  SignalId error_ = catalog_.signals.find("reference.base.error_m").value();
  SignalId height_ = catalog_.signals.find("plant.base.height_m").value();
};

}  // namespace

TEST_CASE("While squatting, switching PID, computed torque, impedance every second keeps the robot up within 15 mm") {
  ScenarioConfig scenario = read_scenario_config(robot_with_three_objects());
  scenario.behaviors.clear();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    RunLog log;
    Assembly robot(scenario, seed, log);
    Checks checks(robot.catalog().signals);
    const RunParts parts = robot.parts();
    Switcher switcher(robot.catalog(), parts.control.exchange());
    const RunResult result = run_scenario(parts, 20.0, checks, {&switcher});
    MESSAGE("largest height error ", 1000 * switcher.worst_m, " mm in ", switcher.switches, " switches");
    CHECK(result.error.empty());
    CHECK(result.commands_refused == 0);
    CHECK(switcher.switches == 19);
    CHECK(switcher.lowest_m > 0.7);
    CHECK(switcher.lowest_m < 0.8);
    CHECK(switcher.worst_m < 0.015);
  }
}

TEST_CASE("A switch is bounded as the configuration says, and foreseen with each joint's own filter") {
  Robot robot = read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json");
  robot.config.switching = {.step_max = 0.01, .fade_s = 0.5};
  robot.config.estimate.velocity_cutoff_Hz = 100;
  robot.config.estimate.joint_velocity_cutoff_Hz.at(3) = 50;
  robot.config.estimate.sample_divisor.at(3) = 2;
  const auto system = make_control_system(robot);
  CHECK(system->catalog.switching.step_max == 0.01);
  CHECK(system->catalog.switching.fade_s == 0.5);
  CHECK(system->catalog.drives.at(0).velocity_delay_s == doctest::Approx(0.00225 + 0.0005).epsilon(1e-3));
  CHECK(system->catalog.drives.at(3).velocity_delay_s == doctest::Approx(0.0045 + 0.001).epsilon(1e-3));
}
