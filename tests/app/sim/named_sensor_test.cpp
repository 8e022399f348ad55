// A sensor that nothing but the robot's configuration names, from the model to the behavior, the record and the faults.
#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

// JIWIY with a distance ahead and a switch, and a behavior that ends when something is near.
fs::path project_with_sensors(const std::string& name) {
  const fs::path folder = project_copy(name);
  const fs::path robot = folder / "config/jiwiy/robot.json";
  REQUIRE(edit(robot, "\"start\": {", R"("sensors": {
    "front": { "unit": "m", "doc": "Distance ahead.", "min": 0.05, "max": 4, "period_s": 0.02, "value": 2, "noise": 0.001 },
    "lid": { "doc": "1 while it is open." }
  },
  "start": {)"));
  write(folder / "behaviors/jiwiy/near.lua", R"(local k = require "kadans"
return k.behavior "near" {
  initial = "far",
  k.state "far" { { when = function(s) return s.sensors.front < 1 and s.sensors.lid == 0 end, to = "seen" } },
  k.final "seen" { outcome = "done" },
}
)");
  write(folder / "config/scenarios/near.json", R"({
  "name": "near", "robot": "config/jiwiy/robot.json", "behaviors": ["behaviors/jiwiy/near.lua"], "plant": "ideal", "duration_s": 2,
  "set": { "sensor.front.noise": 0 },
  "faults": [{ "kind": "sensor_offset", "of": "front", "from_s": 1, "size": -1.5 }],
  "checks": [
    { "name": "read far", "kind": "always", "signal": "sensor.front", "min": 1.999, "until_s": 0.99 },
    { "name": "read near", "kind": "at_end", "signal": "sensor.front", "min": 0.499, "max": 0.501 },
    { "name": "ended", "kind": "at_end", "that": "play.done == 1" }
  ]
})");
  return folder;
}

}  // namespace

TEST_CASE(
    "a sensor that the configuration names is in checks, records and behaviors, and scenarios set it and break it") {
  const fs::path folder = project_with_sensors("named_sensor");
  const Outcome sim = run("sim config/scenarios/near.json --record near.mcap", folder);
  CAPTURE(sim.out);
  CAPTURE(sim.err);
  CHECK(sim.exit_code == 0);
  CHECK(has(run("log csv near.mcap sensor.front --every 0.5", folder).out, "sensor.front"));
  CHECK(run("check config/jiwiy/robot.json behaviors/jiwiy/near.lua config/scenarios/near.json", folder).exit_code ==
        0);
  REQUIRE(edit(folder / "config/scenarios/near.json", "-1.5", "-1.99"));
  const Outcome beyond = run("sim config/scenarios/near.json --no-record", folder);
  CHECK(has(beyond.out + beyond.err, "channel_range"));
  CHECK(has(beyond.out + beyond.err, "front"));
}

TEST_CASE("a sensor's name that is none is told with the nearest one, wherever it stands") {
  const fs::path folder = project_with_sensors("named_sensor_wrong");
  const fs::path scenario = folder / "config/scenarios/near.json";
  REQUIRE(edit(scenario, "\"of\": \"front\"", "\"of\": \"frnt\""));
  CHECK(has(run("sim config/scenarios/near.json --no-record", folder).err, "did you mean 'front'"));
  REQUIRE(edit(scenario, "\"of\": \"frnt\"", "\"of\": \"front\""));
  REQUIRE(edit(scenario, "sensor.front.noise", "sensor.frnt.noise"));
  CHECK(has(run("sim config/scenarios/near.json --no-record", folder).err, "did you mean 'sensor.front.noise'"));
  REQUIRE(edit(scenario, "sensor.frnt.noise", "sensor.front.noise"));
  REQUIRE(edit(folder / "behaviors/jiwiy/near.lua", "s.sensors.front", "s.sensors.frnt"));
  const Outcome checked = run("check behaviors/jiwiy/near.lua", folder);
  CAPTURE(checked.out);
  CAPTURE(checked.err);
  CHECK(checked.exit_code == 2);
  CHECK(has(checked.out + checked.err, "did you mean 'front'"));
  const fs::path robot = folder / "config/jiwiy/robot.json";
  REQUIRE(edit(robot, "\"lid\":", "\"lid up\":"));
  CHECK(has(run("check config/jiwiy/robot.json", folder).err, "'lid up' is no name of a sensor"));
}
