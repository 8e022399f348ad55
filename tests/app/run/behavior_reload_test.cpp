// Reloads and failures of scripts under the whole robot: TULip in Bullet.
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

namespace behavior_reload_test {

using namespace kadans;

namespace {

const std::filesystem::path squat = KADANS_SOURCE_DIR "/behaviors/tulip/squat.lua";

ScenarioConfig squat_scenario() { return read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json"); }

ScenarioEvent reload(double at_s, const std::filesystem::path& file) {
  return {at_s, {.kind = PlayOrder::Kind::reload, .behavior = {"squat", {}}, .file = file}};
}

struct Played {
  RunResult result;
  RunLog log;
  double height_m = 0, tilt_rad = 0;
  std::string state;
};

void play(const ScenarioConfig& scenario, double duration_s, Played& played) {
  Assembly robot(scenario, 3, played.log);
  Checks checks(robot.catalog().signals);
  const RunParts parts = robot.parts();
  played.result = run_scenario(parts, duration_s, checks, {});
  const auto row = parts.control.row();
  played.height_m = row[robot.catalog().signals.find("plant.base.height_m").value()];
  played.tilt_rad = row[robot.catalog().signals.find("plant.base.tilt_rad").value()];
  played.state = robot.host().behavior(0).state();
}

std::string text_of(const std::filesystem::path& file) { return program::read(file); }

}  // namespace

TEST_CASE("A squat whose file is reloaded again and again with the same text is the same squat, bit for bit") {
  const int reloads = std::getenv("KADANS_SOAK") != nullptr ? 1000 : 50;
  ScenarioConfig scenario = squat_scenario();
  Played alone;
  play(scenario, 5, alone);
  for (int i = 0; i < reloads; ++i) scenario.events.push_back(reload(4.9 * i / reloads, squat));
  Played reloaded;
  play(scenario, 5, reloaded);
  CHECK(reloaded.result.state_hash == alone.result.state_hash);
  CHECK(reloaded.result.commands_refused == 0);
  CHECK(reloaded.log.lines().empty());
}

TEST_CASE("A squat that gets another depth while it is down goes on squatting, and the run repeats") {
  const auto folder = program::fresh_folder("reload_depth");
  std::string text = text_of(squat);
  text.replace(text.find("0.10, min"), 4, "0.05");
  program::write(folder / "squat.lua", text);
  ScenarioConfig scenario = squat_scenario();
  scenario.events.push_back(reload(4, folder / "squat.lua"));
  Played first, second;
  play(scenario, 12, first);
  play(scenario, 12, second);
  REQUIRE(first.log.lines().size() == 1);
  CHECK(first.log.lines()[0].text.find("reloaded") == 0);
  CHECK(first.result.state_hash == second.result.state_hash);
  CHECK(first.result.commands_refused == 0);
  CHECK(first.height_m > 0.8);
  CHECK(first.tilt_rad < 0.05);
}

TEST_CASE("A reload of a file that is wrong leaves the squat as it was, bit for bit, and says the line") {
  const auto folder = program::fresh_folder("reload_wrong");
  std::string text = text_of(squat);
  program::write(folder / "squat.lua", text.substr(0, text.size() - 40));
  ScenarioConfig scenario = squat_scenario();
  Played alone;
  play(scenario, 5, alone);
  scenario.events.push_back(reload(3, folder / "squat.lua"));
  Played reloaded;
  play(scenario, 5, reloaded);
  CHECK(reloaded.result.state_hash == alone.result.state_hash);
  REQUIRE(reloaded.log.lines().size() == 1);
  CHECK(reloaded.log.lines()[0].text.find("squat.lua:") != std::string::npos);
  CHECK_FALSE(reloaded.log.has_errors());
}

TEST_CASE("A reload of a behavior that does not play is refused where the scenario names it") {
  ScenarioConfig scenario = squat_scenario();
  scenario.events.push_back(reload(3, squat));
  scenario.events.back().order.behavior = {"sqat", {7, 3}};
  RunLog log;
  try {
    const Assembly robot(scenario, 1, log);
    FAIL("accepted");
  } catch (const InputError& error) {
    CHECK(error.problems().front().line == 7);
    CHECK(error.problems().front().message.find("did you mean 'squat'?") != std::string::npos);
  }
}

}  // namespace behavior_reload_test
