// Plug-ins in the program: shipped control objects out of one end a run with the same state; a type of plant out of one
// is configured, chosen and refused as a shipped one.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "program.h"

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

std::string built(const std::string& plugin) { return KADANS_BINARY_DIR "/tests/plugins/" + plugin + "_plugin.so"; }

void list_plugin(const fs::path& robot, const std::string& plugin) {
  REQUIRE(edit(robot, "\"name\": \"tulip\",", "\"name\": \"tulip\", \"plugins\": [\"" + plugin + "\"],"));
}

std::string state_hash(const fs::path& project) {
  const Outcome outcome = run("sim config/scenarios/soft_squat.json --duration 1.5 --no-record --json", project);
  REQUIRE_MESSAGE(outcome.exit_code <= 1, outcome.err);
  return nlohmann::json::parse(outcome.out).at("state_hash").dump();
}

// TULip with a type of plant of a plug-in, and a scenario on it.
fs::path floating_project(const std::string& name, const std::string& settings) {
  fs::path project = project_copy(name);
  const fs::path robot = project / "config/tulip/robot.json";
  list_plugin(robot, built("spring"));
  REQUIRE(edit(robot, "\"plant\": {", "\"plant\": { \"floating\": " + settings + ","));
  write(project / "config/scenarios/floating.json",
        R"({"name": "floating", "robot": "config/tulip/robot.json", "plant": "floating", "duration_s": 0.2,
  "checks": [{ "name": "height", "kind": "always", "signal": "plant.base.height_m", "min": 1.999, "max": 2.001 }]})");
  return project;
}

}  // namespace

TEST_CASE("Shipped control objects out of a plug-in end a run with the same state as those built in") {
  const fs::path project = project_copy("plugged_objects");
  const std::string built_in = state_hash(project);
  const fs::path tulip = project / "config/tulip/robot.json", soft = project / "config/tulip/soft.json";
  list_plugin(tulip, built("shipped"));
  for (const std::string type : {"joint_pid", "dcm_balance", "stance", "dcm_walk"})
    REQUIRE(edit(tulip, "\"type\": \"" + type + "\"", "\"type\": \"plugged_" + type + "\""));
  REQUIRE(edit(soft, "\"type\": \"spring_torque\"", "\"type\": \"plugged_spring_torque\""));
  CHECK(state_hash(project) == built_in);
}

TEST_CASE("A type of plant out of a plug-in plays a scenario and a run, with its settings") {
  const fs::path project = floating_project("plugged_plant", R"({ "height_m": 2 })");
  const Outcome sim = run("sim config/scenarios/floating.json --no-record", project);
  CHECK_MESSAGE(sim.exit_code == 0, sim.out << sim.err);
  const Outcome live =
      run("run config/tulip/robot.json --plant floating --threads-on-virtual-time --no-ctl --duration 0.2", project);
  CHECK_MESSAGE(live.exit_code == 0, live.err);
  CHECK(run("check --plugins config/scenarios/floating.json", project).exit_code == 0);
}

TEST_CASE("Settings and names of a plug-in's plant are checked when it is loaded, and left alone when it is not") {
  const fs::path project = floating_project("plugged_plant_refused", R"({ "height": 2 })");
  CHECK(run("check config/tulip/robot.json", project).exit_code == 0);
  const Outcome key = run("check --plugins config/tulip/robot.json", project);
  CHECK(key.exit_code == 2);
  CHECK_MESSAGE(has(key.err, "unknown key 'height' in plant.floating, did you mean 'height_m'?"), key.err);

  REQUIRE(edit(project / "config/tulip/robot.json", "\"height\"", "\"height_m\""));
  const fs::path scenario = project / "config/scenarios/floating.json";
  REQUIRE(
      edit(scenario, "\"duration_s\"", "\"world\": [{ \"kind\": \"ground\", \"slope_rad\": 0.1 }], \"duration_s\""));
  const Outcome world = run("sim config/scenarios/floating.json --no-record", project);
  CHECK(world.exit_code == 2);
  CHECK_MESSAGE(has(world.err, "world: the plant floating has none"), world.err);
  REQUIRE(edit(scenario, "\"plant\": \"floating\"", "\"plant\": \"flaoting\""));
  const Outcome model = run("sim config/scenarios/floating.json --no-record", project);
  CHECK(model.exit_code == 2);
  CHECK_MESSAGE(has(model.err, "floating.json:1:"), model.err);
  CHECK_MESSAGE(has(model.err, "unknown type of plant 'flaoting', did you mean 'floating'?"), model.err);
  const Outcome live = run("run config/tulip/robot.json --plant flaoting --soft --no-ctl --duration 0.2", project);
  CHECK(live.exit_code == 2);
  CHECK_MESSAGE(has(live.err, "--plant: unknown type of plant 'flaoting', did you mean 'floating'?"), live.err);
  const Outcome served = run("plant config/tulip/robot.json --as floating --soft --listen 127.0.0.1:0", project);
  CHECK(served.exit_code == 2);
  CHECK_MESSAGE(has(served.err, "--as: unknown type of plant 'floating'"), served.err);
}
