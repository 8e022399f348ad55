// Two control sets at once on the whole robot: TULip in Bullet bends its knees while an arm waves.
#include <algorithm>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

namespace two_sets_test {

using namespace kadans;

namespace {

constexpr const char* objects = R"("objects": [
      {
        "name": "legs", "type": "joint_pid", "joints": ["*_hip_*", "*_knee", "*_ankle_pitch"],
        "parameters": {
          "*.kp_Nm_per_rad": 300, "*.kd_Nms_per_rad": 4, "*.ki_Nm_per_rads": 100, "*.integral_max_Nm": 8,
          "*_hip_yaw.kp_Nm_per_rad": 100, "*_hip_yaw.kd_Nms_per_rad": 2
        }
      },
      {
        "name": "shoulders", "type": "joint_pid", "joints": ["*_shoulder_pitch"],
        "parameters": { "*.kp_Nm_per_rad": 40, "*.kd_Nms_per_rad": 1, "*.ki_Nm_per_rads": 20, "*.integral_max_Nm": 8 }
      },)";

constexpr const char* bends = R"(local k = require 'kadans'
return k.behavior 'bends' { controls = 'legs', initial = 'down',
  k.state 'down' { run = function(m) m.legs:move('squat', { time_s = 1 }):wait() m:wait(0.3)
      m.legs:move('stand', { time_s = 1 }):wait() end, { on = 'run.done', to = 'over' } },
  k.final 'over' { outcome = 'done' } })";

constexpr const char* waves = R"(local k = require 'kadans'
return k.behavior 'waves' { controls = 'shoulders', initial = 'up',
  k.state 'up' { run = function(m) m.shoulders:move({ r_shoulder_pitch = -1 }, { time_s = 1 }):wait() end,
    { on = 'run.done', to = 'over' } },
  k.final 'over' { outcome = 'done' } })";

// Calls the other, which brings its set in.
constexpr const char* bends_and_waves = R"(local k = require 'kadans'
return k.behavior 'both' { controls = 'legs', initial = 'p',
  k.parallel 'p' { k.region 'legs' { k.call 'bends' }, k.region 'arms' { k.call 'waves' }, { on = 'done', to = 'over' } },
  k.final 'over' { outcome = 'done' } })";

class Watch final : public RunObserver {
 public:
  explicit Watch(const Catalog& catalog) {
    const auto signal = [&](const char* name) { return catalog.signals.find(name).value(); };
    height_ = signal("plant.base.height_m"), arm_ = signal("joint.r_shoulder_pitch.position_rad");
    sets_ = signal("engine.control_sets");
  }
  void tick(double /*time_s*/, std::span<const double> row) override {
    lowest_m = std::min(lowest_m, row[height_]);
    arm_rad = row[arm_];
    height_m = row[height_];
    sets = row[sets_];
  }
  double lowest_m = 1, height_m = 0, arm_rad = 0, sets = 0;

 private:
  SignalId height_, arm_, sets_;
};

void check_bends_and_waves(const std::filesystem::path& folder, const char* play) {
  constexpr double sets = 0b11;  // of legs and arms, the first ones of the file
  ScenarioConfig scenario = read_scenario_config(folder / "config/scenarios/squat.json");
  scenario.behaviors = read_play_items(play, "play", {folder / "config/scenarios/squat.json", "tulip"});
  RunLog log;
  Assembly robot(scenario, 3, log);
  Checks checks(robot.catalog().signals);
  Watch watch(robot.catalog());
  const RunResult result = run_scenario(robot.parts(), 3, checks, {&watch});
  CHECK_FALSE(log.has_errors());
  CHECK(result.faults.empty());
  CHECK(robot.host().behavior(0).outcome() == "done");
  CHECK(watch.sets == sets);
  CHECK(watch.lowest_m < 0.8);
  CHECK(watch.height_m > 0.855);
  CHECK(watch.arm_rad == doctest::Approx(-1).epsilon(0.05));
}

std::filesystem::path project(const std::string& name) {
  const auto folder = program::project_copy(name);
  const auto robot = folder / "config/tulip/robot.json";
  REQUIRE(program::edit(robot, "\"objects\": [", objects));
  REQUIRE(program::edit(
      robot, "\"sets\": {",
      "\"sets\": { \"legs\": { \"objects\": [\"legs\"] }, \"shoulders\": { \"objects\": [\"shoulders\"] },"));
  program::write(folder / "behaviors/tulip/bends.lua", bends);
  program::write(folder / "behaviors/tulip/waves.lua", waves);
  program::write(folder / "behaviors/tulip/both.lua", bends_and_waves);
  return folder;
}

}  // namespace

TEST_CASE("Two behaviors play at once on the legs and on the arms, in lanes or called, and the robot stands") {
  const auto folder = project("two_sets");
  check_bends_and_waves(folder, "bends | waves");
  check_bends_and_waves(folder, "both");
}

TEST_CASE("Behaviors that would play at once on joints of both are refused before anything moves") {
  const auto folder = project("clash");
  const program::Outcome outcome =
      program::run("sim config/scenarios/squat.json --play \"squat | waves\" --no-record", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(program::has(outcome.err,
                     "behaviors that play at the same time: control sets 'posture' and 'shoulders' both drive "
                     "joint 'l_shoulder_pitch'"));
}

}  // namespace two_sets_test
