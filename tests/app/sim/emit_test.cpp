// Events from outside in whole simulations: of scenarios, a joystick and a sensor; and their replay.
#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

// JIWIY with a switch and a button that send events, and a behavior that moves by what it gets.
fs::path listening_project(const std::string& name) {
  const fs::path folder = project_copy(name);
  const fs::path robot = folder / "config/jiwiy/robot.json";
  REQUIRE(edit(robot, "\"start\": {", R"("sensors": {
    "lid": { "doc": "1 while it is open.", "events": { "rise": "lid.opened", "fall": "lid.closed" } }
  },
  "start": {)"));
  REQUIRE(edit(robot, "\"joystick\": {", R"("joystick": {
    "buttons": { "button_1": { "press": "pressed", "release": "released" } },)"));
  write(folder / "behaviors/jiwiy/listen.lua", R"(local k = require "kadans"
k.events {
  turn = { "turn the head", pan_rad = { "rad", min = -1, max = 1 }, slowly = { k.flag, optional = true } },
  pressed = {}, released = {}, ["lid.opened"] = {}, ["lid.closed"] = {},
}
local function tell(_, s) print(string.format("%s at %.2f s", s.event.name, s.time_s)) end
return k.behavior "listen" {
  controls = "position",
  k.state "wait" {
    endless = true,
    { on = "turn", to = "wait", action = function(m, s)
      tell(m, s)
      m.profile:move({ pan = s.event.data.pan_rad }, { time_s = s.event.data.slowly and 2 or 0.5 })
    end },
    { on = { "pressed", "released", "lid.opened", "lid.closed" }, to = "wait", action = tell },
  },
}
)");
  write(folder / "config/scenarios/listen.json", R"({
  "name": "listen", "robot": "config/jiwiy/robot.json", "behaviors": ["listen"], "plant": "ideal", "duration_s": 2,
  "events": [
    { "at_s": 0.5, "do": "emit", "event": "turn", "data": { "pan_rad": 0.25 } },
    { "at_s": 1.5, "do": "emit", "event": "pressed" }
  ],
  "checks": [{ "name": "turned", "kind": "at_end", "signal": "joint.pan.position_rad", "min": 0.2, "max": 0.3 }]
})");
  return folder;
}

}  // namespace

TEST_CASE("a scenario emits events at their times, and a replay of its record is the same") {
  const fs::path folder = listening_project("emit_scenario");
  const Outcome sim = run("sim config/scenarios/listen.json --record run.mcap --verbose", folder);
  CAPTURE(sim.out);
  CAPTURE(sim.err);
  CHECK(sim.exit_code == 0);
  CHECK(has(sim.out + sim.err, "turn at 0.50 s"));
  CHECK(has(sim.out + sim.err, "pressed at 1.50 s"));
  CHECK(has(sim.out + sim.err, "event turn {\"pan_rad\":0.25} from scenario to listen"));
  CHECK(has(run("replay run.mcap", folder).out, "the same"));
  CHECK(has(run("log cat run.mcap --topic /events", folder).out,
            "\"event\":\"turn\",\"ordered\":false,\"tick\":500,\"who\":\"scenario\""));
}

TEST_CASE("an event of a scenario is checked against the behaviors that play, with its place in the file") {
  const fs::path folder = listening_project("emit_wrong");
  const fs::path scenario = folder / "config/scenarios/listen.json";
  const auto error = [&](const std::string& from, const std::string& to) {
    const std::string before = read(scenario);
    REQUIRE(edit(scenario, from, to));
    const Outcome outcome = run("sim config/scenarios/listen.json --no-record", folder);
    write(scenario, before);
    CHECK(outcome.exit_code == 2);
    return outcome.err;
  };
  const std::string where = "listen.json:4:";
  CHECK(has(error("\"event\": \"turn\"", "\"event\": \"trun\""),
            where + "43: unknown event 'trun' of the behaviors here, did you mean 'turn'?"));
  CHECK(has(error("\"pan_rad\": 0.25", "\"pan_rad\": 1.5"),
            where + "72: event 'turn': field 'pan_rad' = 1.5 is outside its range -1..1 rad"));
  CHECK(has(error("\"pan_rad\": 0.25", "\"pan_rad\": true"),
            where + "72: event 'turn': field 'pan_rad' must be a number"));
  CHECK(has(error("\"pan_rad\": 0.25", "\"pan\": 1"), where + "68: event 'turn': no field 'pan'"));
  CHECK(has(error("\"pan_rad\": 0.25", ""), "event 'turn': field 'pan_rad' is missing"));
  CHECK(
      has(error("\"pan_rad\": 0.25", "\"pan_rad\": [1]"), where + "72: field 'pan_rad' must be a number, true, false"));
  CHECK(
      has(error("\"do\": \"emit\", \"event\": \"pressed\"", "\"do\": \"emit\""), "event is missing: to emit needs it"));
  CHECK(has(error("\"do\": \"emit\", \"event\": \"pressed\"", "\"do\": \"stop\", \"event\": \"pressed\""),
            "event means nothing here: to stop has none"));
}

TEST_CASE("a button of a joystick's recording and a sensor send the events that the robot's configuration names") {
  const fs::path folder = listening_project("emit_inputs");
  write(folder / "config/joystick/press.evemu",
        "A: 00 0 1023 0 0 0\nA: 01 0 1023 0 0 0\nE: 0.0 1 120 1\nE: 0.0 0 0 0\nE: 0.4 1 120 0\nE: 0.4 0 0 0\n");
  REQUIRE(edit(folder / "config/scenarios/listen.json", "\"checks\"",
               R"("joystick": { "recording": "config/joystick/press.evemu", "at_s": 0.3 },
  "faults": [{ "kind": "sensor_offset", "of": "lid", "from_s": 1, "until_s": 1.2, "size": 1 }],
  "checks")"));
  const Outcome sim = run("sim config/scenarios/listen.json --record run.mcap --verbose", folder);
  CAPTURE(sim.out);
  CAPTURE(sim.err);
  CHECK(sim.exit_code == 0);
  CHECK(has(sim.out + sim.err, "pressed at 0.3"));
  CHECK(has(sim.out + sim.err, "released at 0.7"));
  CHECK(has(sim.out + sim.err, "lid.opened at 1.0"));
  CHECK(has(sim.out + sim.err, "lid.closed at 1.2"));
  CHECK(has(sim.out + sim.err, "event pressed from joystick.button_1 to listen"));
  CHECK(has(run("replay run.mcap", folder).out, "the same"));
  REQUIRE(edit(folder / "config/jiwiy/robot.json", "\"button_1\": { \"press\"", "\"button_9\": { \"press\""));
  CHECK(has(run("check config/jiwiy/robot.json", folder).err, "unknown button 'button_9'"));
  REQUIRE(edit(folder / "config/jiwiy/robot.json", "\"button_9\": { \"press\": \"pressed\"",
               "\"button_1\": { \"press\": \"pressed!\""));
  CHECK(has(run("check config/jiwiy/robot.json", folder).err, "'pressed!' is no name of an event"));
}

TEST_CASE(
    "a scenario says which events the buttons of its joystick send, in place of the robot's for the same buttons") {
  const fs::path folder = listening_project("emit_scenario_buttons");
  write(folder / "config/joystick/press.evemu",
        "A: 00 0 1023 0 0 0\nA: 01 0 1023 0 0 0\nE: 0.0 1 120 1\nE: 0.0 0 0 0\nE: 0.2 1 121 1\nE: 0.2 0 0 0\n"
        "E: 0.4 1 120 0\nE: 0.4 0 0 0\n");
  REQUIRE(edit(folder / "config/jiwiy/robot.json", "\"button_1\": { \"press\"",
               "\"button_2\": { \"press\": \"pressed\" }, \"button_1\": { \"press\""));
  const fs::path scenario = folder / "config/scenarios/listen.json";
  REQUIRE(edit(scenario, "\"checks\"", R"("joystick": {
    "recording": "config/joystick/press.evemu", "at_s": 0.3, "buttons": { "button_1": { "press": "lid.opened" } } },
  "checks")"));
  const Outcome sim = run("sim config/scenarios/listen.json --record run.mcap --verbose", folder);
  const std::string said = sim.out + sim.err;
  CAPTURE(said);
  CHECK(sim.exit_code == 0);
  CHECK(has(said, "lid.opened at 0.3"));
  CHECK(has(said, "event lid.opened from joystick.button_1 to listen"));
  CHECK(has(said, "event pressed from joystick.button_2 to listen"));
  CHECK_FALSE(has(said, "released at"));  // of the robot's button_1, which the scenario replaces
  CHECK(has(run("replay run.mcap", folder).out, "the same"));
  REQUIRE(edit(scenario, "\"button_1\"", "\"button_9\""));
  const std::string wrong = run("check config/scenarios/listen.json", folder).err;
  CHECK(has(wrong, "listen.json:8:"));
  CHECK(has(wrong, "unknown button 'button_9'"));
}

TEST_CASE("the check finds declared events that nothing waits for, and knows declared ones as events that come") {
  const fs::path folder = listening_project("emit_check");
  CHECK(run("behavior check behaviors/jiwiy/listen.lua", folder).exit_code == 0);
  REQUIRE(edit(folder / "behaviors/jiwiy/listen.lua", "{ on = { \"pressed\",", "{ on = { \"presed\","));
  const Outcome checked = run("behavior check behaviors/jiwiy/listen.lua", folder);
  CAPTURE(checked.out);
  CHECK(checked.exit_code == 2);
  CHECK(has(checked.out + checked.err,
            "listen.lua:4: the event 'pressed' is declared, but no transition waits for it, did you mean 'presed'?"));
  CHECK(has(checked.out + checked.err, "nobody emits the event 'presed' here, did you mean 'pressed'?"));
}

TEST_CASE("a test of a behavior sends it events with data, and is told what is wrong with them") {
  const fs::path folder = listening_project("emit_in_test");
  write(folder / "behaviors/jiwiy/listen_test.lua", R"(local k = require "kadans"
describe("listen", function()
  it("turns", function()
    local run = k.play "listen.lua"
    run:advance(0.1)
    run:emit("turn", { pan_rad = 0.5 })
    run:advance(1)
    expect(run.joints.pan.position_rad).to_be_near(0.5, 0.05)
    expect(function() run:emit("turn", { pan_rad = 5 }) end).to_raise "is outside its range -1..1 rad"
    expect(function() run:emit("turn", {}) end).to_raise "field 'pan_rad' is missing"
    expect(function() run:emit("trun") end).to_raise "nothing waits for the event 'trun'"
    expect(function() run:emit("trun", { a = 1 }) end).to_raise "did you mean 'turn'"
  end)
  it("hears the lid", function()
    local run = k.play "listen.lua"
    run:set_sensor("sensors.lid", 0)
    run:advance(0.1)
    run:set_sensor("sensors.lid", 1)
    run:set_sensor("joystick.button_1", true)
    run:advance(0.1)
    expect(run.log).to_contain "lid.opened at 0.1"
    expect(run.log).to_contain "pressed at 0.1"
  end)
end)
)");
  const Outcome tested = run("behavior test behaviors/jiwiy/listen_test.lua", folder);
  CAPTURE(tested.err);
  CHECK_MESSAGE(tested.exit_code == 0, tested.out);
}
