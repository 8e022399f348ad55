// The supervisor's operations: play, replace, pause, resume, stop; and the arguments that a list gives.
#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

using Kind = PlayOrder::Kind;

// Says its name when it enters and leaves, and ends after 0.05 s.
std::string speaker(const std::string& name, const std::string& outcome = "done") {
  return "local k = require 'kadans'\nreturn k.behavior '" + name +
         "' { initial = 'a', exit = function() print 'left' end,\n"
         "k.state 'a' { enter = function() print 'entered' end, { after = 0.05, to = 'b' } },\n"
         "k.final 'b' { outcome = '" +
         outcome + "' } }";
}

// Moves all driven joints to 0.1 rad in a second, then says so; `exit` moves nothing.
const std::string mover =
    "local k = require 'kadans'\nreturn k.behavior 'mover' { controls = 'posture', initial = 'a',\n"
    "k.state 'a' { run = function(m) m.posture:move('lean', { time_s = 1 }):wait() print('arrived ' .. m.time_s) end,\n"
    "  { on = 'run.done', to = 'b' } }, k.final 'b' { outcome = 'done' } }";

void give(Theatre& theatre, Kind kind, const std::vector<std::string>& names = {}) {
  theatre.host->order({.kind = kind, .list = theatre.list(names)});
}

}  // namespace

TEST_CASE("play adds behind what plays, and begins at once when nothing does") {
  Theatre theatre({speaker("one")});
  theatre.scripts.write("behaviors/two.lua", speaker("two"));
  theatre.tick(2);
  give(theatre, Kind::play, {"two", "two"});
  theatre.tick(30);
  CHECK(theatre.log.messages == std::vector<std::string>{"one: entered", "supervisor: play two two", "one: left",
                                                         "two: entered", "two: left", "two: entered", "two: left"});
  CHECK(theatre.host->finished());
  give(theatre, Kind::play, {"two"});
  theatre.tick(1);
  CHECK(theatre.log.messages.back() == "two: entered");
}

TEST_CASE("a list that was played ends at the first behavior that does not end with done, the next list begins anew") {
  Theatre theatre({speaker("one")});
  theatre.scripts.write("behaviors/bad.lua", speaker("bad", "failed"));
  theatre.scripts.write("behaviors/two.lua", speaker("two"));
  give(theatre, Kind::play, {"bad", "two"});
  theatre.tick(30);
  CHECK(theatre.host->finished());
  CHECK(theatre.log.joined().find("two") == theatre.log.joined().rfind("two"));  // only in the order's line
  CHECK(theatre.host->status().done == 1);
  CHECK(theatre.host->status().not_done == 1);
  give(theatre, Kind::play, {"two"});
  theatre.tick(1);
  CHECK(theatre.log.messages.back() == "two: entered");
}

TEST_CASE("replace leaves what plays by its exits, stops its motions, and begins the new list in the same tick") {
  Theatre theatre({mover, speaker("other")}, {0, 1});
  theatre.scripts.write("behaviors/two.lua", speaker("two"));
  theatre.tick(3);
  REQUIRE(theatre.commands(CommandKind::set_point) == 12);
  give(theatre, Kind::replace, {"two"});
  theatre.tick(1);
  CHECK(theatre.log.messages ==
        std::vector<std::string>{"other: entered", "supervisor: replace two", "other: left", "two: entered"});
  CHECK(theatre.commands(CommandKind::cancel_motion) == 12);
  theatre.tick(20);
  CHECK(theatre.host->finished());
  CHECK(theatre.commands(CommandKind::set_point) == 12);
}

TEST_CASE("what an exit moves on the way out does move: motions come to rest before it") {
  Theatre theatre(
      {"local k = require 'kadans'\nreturn k.behavior 'one' { controls = 'posture',\n"
       "exit = function(m) m.posture:move('stand', { time_s = 1 }) end,\n"
       "k.state 'a' { enter = function(m) m.posture:move('lean', { time_s = 1 }) end } }"});
  theatre.tick(2);
  give(theatre, Kind::stop);
  theatre.tick(1);
  REQUIRE(theatre.applied.size() == 3 * 13);
  CHECK(theatre.applied[13 + 1].kind == CommandKind::cancel_motion);
  CHECK(theatre.applied[26 + 1].kind == CommandKind::set_point);
  CHECK(theatre.host->finished());
}

TEST_CASE(
    "a pause in the middle of a motion stops it and the charts, and after it the rest takes the time it had left") {
  Theatre alone({mover}), paused({mover});
  alone.tick(150);
  paused.tick(51);
  give(paused, Kind::pause);
  paused.tick(1);
  CHECK(paused.host->paused());
  CHECK(paused.host->status().phase == 2);
  CHECK(paused.commands(CommandKind::cancel_motion) == 12);
  paused.tick(300);
  CHECK(paused.commands(CommandKind::set_point) == 12);
  CHECK(paused.log.messages == std::vector<std::string>{"supervisor: pause"});
  give(paused, Kind::resume);
  paused.tick(1);
  REQUIRE(paused.commands(CommandKind::set_point) == 24);
  CHECK(paused.applied.back().value == 0.1);
  CHECK(paused.applied.back().duration_s == doctest::Approx(0.49));
  CHECK_FALSE(paused.host->finished());
  paused.tick(60);
  CHECK(paused.host->finished());
  CHECK(alone.log.messages.back() == "mover: arrived 1");
  CHECK(paused.log.messages.back() == "mover: arrived 0.99");  // in the state's time; charts go on a tick after motions
}

TEST_CASE("time in a state stands still in a pause, and so does m:wait") {
  const std::string waits =
      "local k = require 'kadans'\nreturn k.behavior 'waits' { initial = 'a',\n"
      "k.state 'a' { run = function(m) m:wait(0.2) print('ran ' .. m.time_s) end, { after = 0.3, to = 'b' } },\n"
      "k.state 'b' { enter = function(m, s) print('b at ' .. s.time_s) end, endless = true } }";
  Theatre theatre({waits});
  theatre.tick(10);
  give(theatre, Kind::pause);
  theatre.tick(100);
  give(theatre, Kind::resume);
  theatre.tick(10);
  CHECK(theatre.log.messages == std::vector<std::string>{"supervisor: pause", "supervisor: resume"});
  theatre.tick(30);
  REQUIRE(theatre.log.messages.size() == 4);
  CHECK(theatre.log.messages[2] == "waits: ran 0.2");
  CHECK(theatre.log.messages[3] == "waits: b at 0.3");  // the behaviors' clock
}

TEST_CASE("a pause that ends in the tick it began sends nothing, and a second pause holds a motion that went on") {
  Theatre theatre({mover});
  theatre.tick(10);
  give(theatre, Kind::pause);
  give(theatre, Kind::resume);
  theatre.tick(5);
  CHECK(theatre.commands(CommandKind::cancel_motion) == 0);
  give(theatre, Kind::pause);
  theatre.tick(5);
  give(theatre, Kind::resume);
  theatre.tick(1);
  give(theatre, Kind::pause);
  theatre.tick(100);
  CHECK(theatre.commands(CommandKind::cancel_motion) == 24);
  CHECK_FALSE(theatre.host->finished());
  give(theatre, Kind::resume);
  theatre.tick(200);
  CHECK(theatre.host->finished());
}

TEST_CASE("a pause waits for room in the queue, and meanwhile nothing steps") {
  Theatre theatre({mover});
  theatre.tick(5);
  theatre.applying = false;
  while (theatre.queue.free() > 5) REQUIRE(theatre.queue.try_push(Command{.kind = CommandKind::transaction}));
  give(theatre, Kind::pause);
  theatre.tick(200);
  CHECK(theatre.host->paused());
  CHECK(theatre.log.messages == std::vector<std::string>{"supervisor: pause"});
  theatre.applying = true;
  theatre.tick(2);
  CHECK(theatre.commands(CommandKind::cancel_motion) == 12);
}

TEST_CASE("stop and replace end a pause") {
  Theatre theatre({mover});
  theatre.scripts.write("behaviors/two.lua", speaker("two"));
  theatre.tick(10);
  give(theatre, Kind::pause);
  theatre.tick(10);
  give(theatre, Kind::replace, {"two"});
  theatre.tick(10);
  CHECK_FALSE(theatre.host->paused());
  CHECK(theatre.log.messages.back() == "two: left");
  give(theatre, Kind::stop);
  theatre.tick(1);
  CHECK(theatre.host->finished());
  CHECK(theatre.host->status().phase == 0);
}

TEST_CASE("a list with something wrong is refused whole, and what plays goes on") {
  Theatre theatre({mover});
  theatre.scripts.write("behaviors/good.lua", speaker("good"));
  theatre.scripts.write("behaviors/bad.lua", "local x = = 1");
  theatre.tick(2);
  CHECK_THROWS_AS(give(theatre, Kind::replace, {"good", "bad"}), InputError);
  theatre.tick(2);
  CHECK(theatre.log.messages.empty());
  CHECK(theatre.host->size() == 1);
  CHECK_FALSE(theatre.host->finished());
  CHECK(theatre.commands(CommandKind::cancel_motion) == 0);
}

TEST_CASE(
    "orders given beforehand come at their time, their behaviors are loaded and their signals there from the start") {
  Theatre theatre;
  theatre.scripts.write("behaviors/one.lua", mover);
  theatre.scripts.write("behaviors/two.lua", speaker("two"));
  const auto two = theatre.list({"two"});
  theatre.open({.play = theatre.list({"one"}),
                .events = {{300'000'000, {.kind = Kind::replace, .list = two}},
                           {100'000'000, {.kind = Kind::pause}},
                           {200'000'000, {.kind = Kind::resume}}}});
  SignalTable signals;
  theatre.host->declare_signals(signals);
  CHECK(signals.find("behavior.two.state"));
  CHECK(signals.find("play.phase"));
  theatre.tick(10);
  CHECK_FALSE(theatre.host->paused());
  theatre.tick(1);
  CHECK(theatre.host->paused());
  theatre.tick(10);
  CHECK_FALSE(theatre.host->paused());
  theatre.tick(20);
  CHECK(theatre.log.messages == std::vector<std::string>{"supervisor: pause", "supervisor: resume",
                                                         "supervisor: replace two", "two: entered", "two: left"});
  theatre.scripts.write("behaviors/bad.lua", "local x = = 1");
  CHECK_THROWS_AS(theatre.open({.events = {{1, {.kind = Kind::play, .list = theatre.list({"bad"})}}}}), InputError);
}

TEST_CASE("a list gives a behavior its arguments, and values of its parameters") {
  Theatre theatre;
  theatre.scripts.write(
      "behaviors/says.lua",
      "local k = require 'kadans'\n"
      "local P = k.params { depth_m = { 0.1, min = 0.02, max = 0.15, unit = 'm' } }\n"
      "return k.behavior 'says' { args = { word = 'no', loud = false, times = 1, pose = { {} } },\n"
      "k.state 'a' { enter = function(m) print(m.args.word, m.args.loud, m.args.times, P.depth_m) end "
      "} }\n");
  auto list = theatre.list({"says", "says"});
  list[0].arguments = {{"word", "yes"}, {"loud", true}, {"depth_m", 0.05}};
  list[1].lane = 1;
  theatre.open({.play = list});
  theatre.tick(1);
  CHECK(theatre.log.joined() == "yes true 1 0.05\nno false 1 0.1\n");

  const auto refusal = [&](const PlayArgument& argument) {
    list[0].arguments = {argument};
    list[0].source = "--play";
    try {
      theatre.host->order({.kind = Kind::play, .list = list});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal({"wrd", "x", {1, 6}}) == "--play:1:6: behavior 'says' takes no argument 'wrd', did you mean 'word'?");
  CHECK(refusal({"word", 1.0, {1, 6}}) == "--play:1:6: argument 'word' of behavior 'says' is a text");
  CHECK(refusal({"pose", 1.0}) == "--play: argument 'pose' of behavior 'says' is a table, which only k.call can give");
  CHECK(refusal({"depth_m", 0.5}) ==
        "--play: parameter 'depth_m' of behavior 'says' = 0.5 is outside its range 0.02..0.15 m");
  CHECK(refusal({"depth_m", true}) == "--play: parameter 'depth_m' of behavior 'says' is a number");
}

TEST_CASE(
    "a robot's values are the first ones of a behavior's parameters, called or played, and arguments go before them") {
  Theatre theatre;
  theatre.scripts.write("behaviors/deep.lua",
                        "local k = require 'kadans'\n"
                        "local P = k.params { depth_m = { 0.1, min = 0.02, max = 0.15, unit = 'm' } }\n"
                        "return k.behavior 'deep' { initial = 'a', k.state 'a' { enter = function() print(P.depth_m) "
                        "end, { after = 0.01, to = 'b' } }, k.final 'b' { outcome = 'done' } }\n");
  theatre.scripts.write("behaviors/caller.lua",
                        "local k = require 'kadans'\n"
                        "local P = k.params { depth_m = 7 }\n"
                        "return k.behavior 'caller' { initial = 'a', k.state 'a' { enter = function() print(P.depth_m) "
                        "end, k.call 'deep', { on = 'done', to = 'b' } }, k.final 'b' { outcome = 'done' } }\n");
  auto& given = theatre.robot.catalog.behavior_values;
  given = {{"deep", "depth_m", 0.05, "behaviors/deep.lua", "robot.json", 3, 4},
           {"elsewhere", "x", 1, "behaviors/elsewhere.lua", "robot.json", 5, 6}};
  auto list = theatre.list({"deep", "deep", "caller"});
  list[1].arguments = {{"depth_m", 0.03}};
  theatre.open({.play = list});
  CHECK(theatre.host->behavior(0).parameters().front().initial == 0.05);
  theatre.tick(20);
  CHECK(theatre.log.joined() == "0.05\n0.03\n7\n0.05\n");

  const auto refusal = [&](const BehaviorValue& value) {
    given = {value};
    try {
      theatre.host->order({.kind = Kind::play, .list = theatre.list({"caller"})});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal({"deep", "dept_m", 0.05, "behaviors/deep.lua", "robot.json", 3, 4}) ==
        "robot.json:3:4: behavior 'deep' has no parameter 'dept_m', did you mean 'depth_m'?");
  CHECK(refusal({"deep", "depth_m", 0.5, "behaviors/deep.lua", "robot.json", 3, 4}) ==
        "robot.json:3:4: parameter 'depth_m' of behavior 'deep' = 0.5 is outside its range 0.02..0.15 m");
}

TEST_CASE("a reload from another file keeps the robot's values") {
  Theatre theatre;
  const std::string text =
      "local k = require 'kadans'\nlocal P = k.params { depth_m = 0.1 }\nreturn k.behavior 'says' { k.state 'a' { "
      "during "
      "= function() print(P.depth_m) end } }\n";
  theatre.scripts.write("behaviors/says.lua", text);
  theatre.robot.catalog.behavior_values = {{"says", "depth_m", 0.05, "behaviors/says.lua", "robot.json", 3, 4}};
  theatre.open({.play = theatre.list({"says"})});
  theatre.tick(1);
  const auto later = theatre.scripts.write("behaviors/later.lua", text + "-- new\n");
  theatre.host->order({.kind = Kind::reload, .behavior = {"says", {}}, .file = later});
  theatre.tick(1);
  CHECK(theatre.log.joined() == "0.05\nreloaded behaviors/later.lua\n0.05\n");
}

TEST_CASE("a reload keeps the arguments") {
  Theatre theatre;
  const std::string text =
      "local k = require 'kadans'\nreturn k.behavior 'says' { args = { word = 'no' }, k.state 'a' { during = "
      "function(m) print(m.args.word) end } }\n";
  theatre.scripts.write("behaviors/says.lua", text);
  auto list = theatre.list({"says"});
  list[0].arguments = {{"word", "yes"}};
  theatre.open({.play = list});
  theatre.tick(1);
  const auto later = theatre.scripts.write("behaviors/later.lua", text + "-- new\n");
  theatre.host->order({.kind = Kind::reload, .behavior = {"says", {}}, .file = later});
  theatre.tick(1);
  CHECK(theatre.log.joined() == "yes\nreloaded behaviors/later.lua\nyes\n");
  CHECK_THROWS_AS(theatre.host->order({.kind = Kind::reload, .behavior = {"sais", {}}, .file = later}), InputError);
}
