// Tests of behaviors, as their authors write and run them.
#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;

namespace {

Outcome tested(const std::string& name, const std::string& text) {
  const auto project = project_copy(name);
  write(project / "behaviors/tulip/my_test.lua", text);
  return run("behavior test behaviors/tulip/my_test.lua", project);
}

}  // namespace

TEST_CASE("behavior test tells a failed expectation with its line and what was there, and exits 1") {
  const Outcome outcome = tested("lua_test_fails",
                                 "local k = require 'kadans'\n"
                                 "describe('squat', function()\n"
                                 "  it('is down at once', function()\n"
                                 "    local run = k.play 'squat.lua'\n"
                                 "    run:advance(0.5)\n"
                                 "    expect(run.state).to_equal 'squat'\n"
                                 "  end)\n"
                                 "  it('begins at rest', function()\n"
                                 "    local run = k.play 'squat.lua'\n"
                                 "    run:advance(0.5)\n"
                                 "    expect(run.state).never.to_equal 'squat'\n"
                                 "  end)\n"
                                 "end)\n");
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "behaviors/tulip/my_test.lua:6: expected \"settle\" to equal \"squat\""));
  CHECK(has(outcome.out, "FAILED  squat is down at once"));
  CHECK(has(outcome.out, "ok      squat begins at rest"));
  CHECK(has(outcome.out, "1 passed, 1 failed"));
}

TEST_CASE("a mistake in a test is told with its line and what there is") {
  const Outcome outcome = tested("lua_test_mistakes",
                                 "local k = require 'kadans'\n"
                                 "it('a', function() expect(1).to_equals(1) end)\n"
                                 "it('b', function() k.play 'squt.lua' end)\n"
                                 "it('c', function() k.play('squat.lua'):set_sensor('base.pitch', 1) end)\n"
                                 "it('d', function() k.play('squat.lua'):emit('jump') end)\n"
                                 "it('e', function() k.play('squat.lua'):set_parameter('repeats', 1000) end)\n"
                                 "it('f', function() local x = k.play('squat.lua').joints.l_kne end)\n"
                                 "it('g', function() local run = k.play('squat.lua') run:advance_to('rest', 0.1) end)\n"
                                 "it('h', function() k.play('squat.lua'):set_posture('flat') end)\n"
                                 "it('i', function() k.play('squat.lua'):set_seen('ball', { x = 1 }) end)\n");
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "my_test.lua:2: expect(...) has no 'to_equals'"));
  CHECK(has(outcome.out, "my_test.lua:3: "));
  CHECK(has(outcome.out, "my_test.lua:4: no sensor 'base.pitch'"));
  CHECK(has(outcome.out, "my_test.lua:5: nothing waits for the event 'jump'"));
  CHECK(has(outcome.out, "my_test.lua:6: no parameter 'repeats', or the value is outside its range"));
  CHECK(has(outcome.out, "my_test.lua:7: s.joints has no 'l_kne', did you mean 'l_knee'?"));
  CHECK(has(outcome.out, "my_test.lua:8: \"rest\" was not reached within 0.1 s"));
  CHECK(has(outcome.out, "my_test.lua:9: set_posture needs upright, prone, supine, left or right"));
  CHECK(has(outcome.out, "my_test.lua:10: no sensor 'seen.ball."));
  CHECK(has(outcome.out, "0 passed, 9 failed"));
}

TEST_CASE("a test file that does not load exits 2 with its line") {
  const Outcome outcome = tested("lua_test_syntax", "local k =\n= 1\n");
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "behaviors/tulip/my_test.lua:2: "));
}

TEST_CASE("a behavior that errors in a test is told by its outcome and error") {
  const auto project = project_copy("lua_test_error");
  write(project / "behaviors/tulip/broken.lua",
        "local k = require 'kadans'\nreturn k.behavior 'broken' { k.state 'a' { endless = true,\n"
        "enter = function() error('oh') end } }\n");
  write(project / "behaviors/tulip/broken_test.lua",
        "local k = require 'kadans'\nit('says so', function()\n  local run = k.play 'broken.lua'\n"
        "  expect(run:finish(1)).to_equal 'error'\n  expect(run.error).to_contain 'broken.lua:3: oh'\nend)\n");
  const Outcome outcome = run("behavior test behaviors/tulip/broken_test.lua", project);
  INFO(outcome.out);
  CHECK(outcome.exit_code == 0);
}

TEST_CASE("k.play refuses an option that it does not have, and what is no file") {
  const Outcome outcome = tested("lua_test_options",
                                 "local k = require 'kadans'\n"
                                 "it('a', function() k.play('squat.lua', { robt = 'config/tulip/robot.json' }) end)\n"
                                 "it('b', function() k.play('squat.lua', 'config/tulip/robot.json') end)\n"
                                 "it('c', function() k.play('squat.lua', { robot = 1 }) end)\n"
                                 "it('d', function() k.play() end)\n"
                                 "it('e', function() k.play('squat.lua', { robot = 'config/tulip/soft.json' }) end)\n"
                                 "it('f', function() k.play('squat.lua', { plant = 'bulet' }) end)\n"
                                 "it('g', function() local run = k.play('squat.lua', { plant = 'bullet' })\n"
                                 "  run:advance(0.5) expect(run.feet.left.contact).to_be_true() end)\n"
                                 "it('h', function() local run = k.play('squat.lua')\n"
                                 "  run:advance(0.5) expect(run.feet.left.contact).to_be_false() end)\n");
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "my_test.lua:2: k.play has no option 'robt'; there are: robot, plant, scenario"));
  CHECK(has(outcome.out, "my_test.lua:3: k.play: options are a table, { robot = FILE }"));
  CHECK(has(outcome.out, "my_test.lua:4: k.play: robot must be a text, not a number"));
  CHECK(has(outcome.out, "my_test.lua:5: k.play needs the file of a behavior"));
  CHECK(has(outcome.out, "unknown plant 'bulet', did you mean 'bullet'?"));
  CHECK(has(outcome.out, "3 passed, 5 failed"));
}

TEST_CASE("behavior test runs what its filter names, and tells it as JSON lines and as JUnit XML") {
  const auto project = project_copy("lua_test_filter");
  write(project / "behaviors/tulip/my_test.lua",
        "describe('arms', function() it('rise', function() end) it('sink', function() expect(1).to_equal(2) end) end)\n"
        "it('legs rise', function() end)\n");
  const std::string mine = "behavior test behaviors/tulip/my_test.lua ";
  CHECK(has(run(mine + "--only rise", project).out, "2 passed, 0 failed"));
  CHECK(has(run(mine + "--only 'arms '", project).out, "1 passed, 1 failed"));
  const Outcome none = run(mine + "--only rsie", project);
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "no test has 'rsie' in its name"));
  const Outcome json = run(mine + "--json --junit out.xml", project);
  CHECK(json.exit_code == 1);
  CHECK(has(json.out, R"("test":"arms rise","status":"passed")"));
  CHECK(has(json.out, R"("test":"arms sink","status":"failed")"));
  CHECK(has(json.out, "my_test.lua:1: expected 1 to equal 2"));
  CHECK_FALSE(has(json.out, "passed, "));
  const std::string xml = read(project / "out.xml");
  CHECK(has(xml, "tests=\"3\" failures=\"1\" errors=\"0\""));
  CHECK(has(xml, "name=\"arms sink\""));
}

TEST_CASE("a file of tests that does not load is told, the others run, and what stands above a test goes before it") {
  const auto project = project_copy("lua_test_others");
  write(project / "behaviors/tulip/a_test.lua", "it('never'\n");
  write(project / "behaviors/tulip/b_test.lua",
        "describe('b', function() local log = ''\n"
        "it('has nothing before it', function() expect(log).to_equal '' end)\n"
        "before_each(function() log = log .. 'x' end)\n"
        "it('has one', function() expect(log).to_equal 'x' end)\n"
        "describe('deeper', function() before_each(function() log = log .. 'y' end)\n"
        "it('has both', function() expect(log).to_equal 'xxy' end) end) end)\n"
        "it('is not inside another', function() it('x', function() end) end)\n");
  const Outcome outcome = run("behavior test behaviors/tulip/a_test.lua behaviors/tulip/b_test.lua", project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "behaviors/tulip/a_test.lua:2:"));
  CHECK(has(outcome.out, "3 passed, 1 failed"));
  CHECK(has(outcome.out, "it belongs into describe, not into another it"));
}

TEST_CASE(
    "decisions are tested without anything that plays: the world, the ends of plays and messages are the test's") {
  const auto project = project_copy("lua_test_decisions");
  write(project / "behaviors/tulip/pass.lua", R"(local k = require "kadans"
k.events { ["robot.pass"] = { x_m = { "m", min = -10, max = 10 }, from = { k.text, optional = true } },
           whistle = { loud = k.flag } }
return k.decisions "pass" {
  initial = "a",
  k.state "a" {
    enter = function(m) m:play("squat", { repeats = 2 }) end,
    { on = "play.done", to = "b" },
    { on = "play.failed", to = "c" },
    { on = "robot.pass", to = "d", action = function(_, s) k.log.info("%s at %g", s.event.data.from, s.event.data.x_m) end },
    { when = function(_, m) return m:plays("squat") == "squat" end, to = "e" },
  },
  k.state "b" { enter = function(m) m:replace("squat{repeats=-5}") end, { on = "play.refused", to = "c" } },
  k.state "c" { endless = true, enter = function(m, s) m:send("robot.pass", { x_m = s.seen.ball.x_m }) m:stop() end },
  k.state "d" { endless = true, enter = function(m) m:emit("whistle", { loud = true }, { to = "squat" }) end },
  k.state "e" { endless = true },
}
)");
  write(project / "behaviors/tulip/pass_test.lua", R"(local k = require "kadans"
local run
describe("pass", function()
  before_each(function()
    run = k.play("pass.lua", { scenario = "config/scenarios/fetch.json" })
    run:set_sensor("seen.ball.x_m", 1.5)
    run:advance(0.1)
  end)
  it("plays", function()
    expect(run.orders).to_equal { { word = "play", list = "squat", arguments = { repeats = 2 } } }
    expect(run.messages).to_equal {}
  end)
  it("hears the end, and what was refused", function()
    run:play_ends()
    run:advance(0.2)
    expect(run.states).to_equal "a b c"
    expect(run.orders[2].refused).to_contain "repeats"
    expect(run.orders[3]).to_equal { word = "stop" }
    expect(run.messages).to_equal { { event = "robot.pass", data = { x_m = 1.5 } } }
  end)
  it("hears a failure", function()
    run:play_ends("failed")
    run:advance(0.1)
    expect(run.state).to_equal "c"
  end)
  it("hears a message", function()
    run:emit("robot.pass", { x_m = 2, from = "red_2" })
    run:advance(0.1)
    expect(run.log).to_contain "red_2 at 2"
    expect(run.orders[2]).to_equal { word = "emit", event = "whistle", data = { loud = true }, to = "squat" }
  end)
  it("sees what plays", function()
    run:plays("squat", "squat")
    run:advance(0.1)
    expect(run.state).to_equal "e"
  end)
  it("A", function() run:plays("walk", "squat") end)
  it("B", function() run:play_ends("dnoe") end)
  it("C", function() run:play_ends() run:play_ends() end)
  it("D", function() k.play("squat.lua"):play_ends() end)
  it("E", function() run:emit("robot.pas", {}) end)
  it("F", function() k.play("pass.lua", { scenario = "config/scenarios/fetsh.json" }) end)
  it("G", function() run:set_sensor("seen.bal.x_m", 1) end)
end)
)");
  const Outcome outcome = run("behavior test behaviors/tulip/pass_test.lua", project);
  CAPTURE(outcome.err);
  CAPTURE(outcome.out);
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.out, "5 passed, 7 failed"));
  CHECK(has(outcome.out, "pass_test.lua:37: plays: 'walk' does not play; what does: squat"));
  CHECK(has(outcome.out, "pass_test.lua:38: play_ends: what plays ends as \"done\" or \"failed\""));
  CHECK(has(outcome.out, "pass_test.lua:39: play_ends: nothing plays"));
  CHECK(has(outcome.out, "pass_test.lua:40: play_ends: nothing decides here"));
  CHECK(has(outcome.out, "pass_test.lua:41: the decisions do not declare the event 'robot.pas'"));
  CHECK(has(outcome.out, "fetsh.json"));
  CHECK(has(outcome.out, "pass_test.lua:43: no sensor 'seen.bal.x_m'"));
}

TEST_CASE(
    "behavior test tells files without tests, behaviors that are not there, and knows a behavior that has ended") {
  const Outcome none = tested("lua_test_none", "-- it('a', function() end)\n");
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "my_test.lua: no tests: describe(NAME, function) and it(NAME, function) make them"));
  const Outcome bare = tested("lua_test_bare", "describe('a')\n");
  CHECK(bare.exit_code == 2);
  CHECK(has(bare.err, "my_test.lua:1: describe(\"a\") needs a function"));
  const Outcome ended = tested("lua_test_ended",
                               "local k = require 'kadans'\n"
                               "it('a', function() k.play('squat.lua'):advance_to('done') end)\n"
                               "it('b', function() k.play('no/such.lua') end)\n");
  CHECK(ended.exit_code == 1);
  CHECK_MESSAGE(has(ended.out, "1 passed, 1 failed"), ended.out);
  CHECK_MESSAGE(has(ended.out, "such.lua: there is no such file"), ended.out);
}
