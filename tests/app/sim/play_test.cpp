// Lists of behaviors under the whole robot: TULip in Bullet.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

using namespace kadans;

namespace {

using Kind = PlayOrder::Kind;

const std::filesystem::path behaviors = KADANS_SOURCE_DIR "/behaviors/tulip";

struct Played {
  double travel_rad = 0;    // of the left knee, while it is watched
  double jump_max_rad = 0;  // of it, from tick to tick, in the whole run
  double height_m = 0;
  std::string outcome, state;
  bool errors = false;
  std::uint64_t sum = 0;  // of all knee positions, for comparing runs
};

// The squat with these events; the knee is watched between the two times.
Played play(const std::vector<ScenarioEvent>& events, double duration_s, double from_s, double until_s) {
  ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  scenario.events = events;
  RunLog log;
  Assembly robot(scenario, 3, log);
  const RunParts parts = robot.parts();
  const auto row = parts.control.row();
  const SignalId knee = robot.catalog().signals.find("joint.l_knee.position_rad").value();
  Played played;
  double before_rad = 0, least_rad = 10, greatest_rad = -10;
  while (parts.lockstep.time_ns() < std::llround(duration_s * 1e9)) {
    const double time_s = 1e-9 * static_cast<double>(parts.lockstep.time_ns());
    parts.truth.update(time_s, row);
    parts.lockstep.step();
    const double step_rad = parts.control.ticks() > 1 ? std::abs(row[knee] - before_rad) : 0;
    before_rad = row[knee];
    played.jump_max_rad = std::max(played.jump_max_rad, step_rad);
    if (time_s >= from_s && time_s < until_s) {
      least_rad = std::min(least_rad, row[knee]);
      greatest_rad = std::max(greatest_rad, row[knee]);
    }
    played.sum = played.sum * 31 + static_cast<std::uint64_t>(std::llround(row[knee] * 1e12));
  }
  played.travel_rad = greatest_rad - least_rad;
  played.height_m = row[robot.catalog().signals.find("plant.base.height_m").value()];
  played.outcome = robot.host().behavior(0).outcome();
  played.state = robot.host().behavior(0).state();
  played.errors = log.has_errors();
  return played;
}

}  // namespace

TEST_CASE(
    "A squat that is paused on its way down stands still without a jump, goes on and ends up standing, repeatably") {
  const std::vector<ScenarioEvent> pause{{2.0, {.kind = Kind::pause}}, {4.0, {.kind = Kind::resume}}};
  const Played alone = play({}, 4, 2, 3);
  const Played paused = play(pause, 4, 2.5, 4.0);
  CHECK(alone.travel_rad > 0.2);
  CHECK(paused.travel_rad < 0.01);
  CHECK(paused.jump_max_rad < 1.5 * alone.jump_max_rad);
  CHECK(paused.state == "squat");
  const Played whole = play(pause, 8, 4, 8);
  CHECK(whole.jump_max_rad < 2.2 * alone.jump_max_rad);
  CHECK(whole.height_m > 0.75);
  CHECK_FALSE(whole.errors);
  CHECK(play(pause, 8, 4, 8).sum == whole.sum);
}

TEST_CASE("A squat that is replaced on its way down leaves its knees without a jump, and the wave is played") {
  const std::vector<ScenarioEvent> replace{{2.0, {.kind = Kind::replace, .list = {{.file = behaviors / "wave.lua"}}}}};
  const Played alone = play({}, 3, 0, 3);
  const Played replaced = play(replace, 9, 2.3, 2.6);
  CHECK(replaced.jump_max_rad < 1.5 * alone.jump_max_rad);
  CHECK(replaced.travel_rad < 0.01);
  CHECK(replaced.outcome.empty());  // the squat never ended
  CHECK_FALSE(replaced.errors);
}

TEST_CASE("sim --play plays a list in place of the scenario's, and refuses a wrong one before anything moves") {
  const auto project = program::project_copy("sim_play");
  const std::string sim = "sim config/scenarios/squat.json --no-record --duration 6 --verbose --play ";
  const program::Outcome outcome = program::run(sim + "'wave{swing_rad=0.2}, squat'", project);
  CHECK(program::has(outcome.out, "--play 'wave{swing_rad=0.2}, squat'"));
  CHECK(program::has(outcome.out, "wave"));
  const std::pair<const char*, const char*> wrong[] = {
      {"'wave{swing=0.2}'", "--play:1:6: behavior 'wave' takes no argument 'swing', did you mean 'swing_rad'?"},
      {"'wave, squta'", "--play:1:7: unknown behavior 'squta'"},
      {"'wave{swing_rad=9}'",
       "--play:1:6: parameter 'swing_rad' of behavior 'wave' = 9 is outside its range 0..0.6 rad"},
      {"'wave squat'", "--play:1:6: what to play: wanted a comma"}};
  for (const auto& [list, message] : wrong) {
    const program::Outcome refused = program::run(sim + list, project);
    CHECK(refused.exit_code == 2);
    CHECK(program::has(refused.err, message));
    CHECK(refused.out.empty());
  }
}

TEST_CASE("A scenario's events are refused with their place when something in them is wrong") {
  const auto project = program::project_copy("sim_events");
  const auto refusal = [&](const std::string& event) {
    program::write(project / "config/scenarios/events.json",
                   "{ \"name\": \"events\", \"robot\": \"config/tulip/robot.json\", \"duration_s\": 1,\n"
                   "  \"behaviors\": [\"squat\", \"wave{swing_rad=0.2}\"],\n  \"events\": [" +
                       event + "] }\n");
    return program::run("check config/scenarios/events.json", project).err;
  };
  CHECK(refusal("{ \"at_s\": 1, \"do\": \"pause\" }").empty());
  CHECK(program::has(refusal("{ \"at_s\": 1, \"do\": \"play\" }"), "events.json:3:14: "));
  CHECK(program::has(refusal("{ \"at_s\": 1, \"do\": \"stop\", \"list\": \"squat\" }"), "means nothing here"));
  CHECK(program::has(refusal("{ \"at_s\": 1, \"do\": \"play\", \"list\": \"wave, squta\" }"),
                     "events.json:3:56: unknown behavior 'squta'"));
  CHECK(program::has(refusal("{ \"at_s\": 1, \"do\": \"reload\", \"behavior\": \"squta\", \"file\": "
                             "\"behaviors/tulip/squat.lua\" }"),
                     "did you mean 'squat'?"));
}

TEST_CASE("params lists the arguments of a behavior with type, default, unit and range") {
  const auto project = program::project_copy("params_arguments");
  program::write(project / "behaviors/tulip/bow.lua", R"(local k = require "kadans"
k.params { hold_s = { 1, unit = "s", min = 0, max = 9, doc = "how long" } }
local A = k.args { depth_m = { 0.1, min = 0.02, max = 0.2, unit = "m", doc = "how far down" }, again = { false },
                   side = { "left", one_of = { "left", "right" } }, path = { { 1, 2 } } }
return k.behavior "bow" { k.final "over" { outcome = A and "done" } })");
  const auto listed = program::run("params behaviors/tulip/bow.lua", project);
  CAPTURE(listed.out + listed.err);
  std::string text = listed.out;  // with single blanks
  text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }), text.end());
  CHECK(text ==
        "hold_s 1 s 0..9 how long\n"
        "arguments:\n"
        "again false any boolean \n"
        "depth_m 0.1 m 0.02..0.2 how far down\n"
        "path a table any table \n"
        "side \"left\" one of left, right \n");
  const std::string json = program::run("params behaviors/tulip/bow.lua --json", project).out;
  CHECK(program::has(json, R"({"name":"depth_m","argument":"number","value":0.1,"unit":"m","min":0.02,"max":0.2,)"));
  CHECK(program::has(json, R"("argument":"text","value":"left","unit":"","min":null,"max":null,"one_of":["left",)"));
}
