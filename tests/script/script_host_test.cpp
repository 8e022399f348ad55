// Several behaviors: lists, lanes, and that a failure stays where it is.
#include "script/host/script_host.h"

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

std::string behavior(const std::string& name, const std::string& states) {
  return "local k = require 'kadans'\nreturn k.behavior '" + name + "' { " + states + " }";
}
std::string lasting(const std::string& name, const std::string& outcome) {
  return behavior(name,
                  "initial = 'a', k.state 'a' { enter = function(m, s) print(s.time_s) end, { after = 0.05, to = 'b' } "
                  "}, k.final 'b' { outcome = '" +
                      outcome + "' }");
}

}  // namespace

TEST_CASE("a list is played one behavior after the other") {
  Theatre theatre({lasting("one", "done"), lasting("two", "done")});
  theatre.tick(5);
  CHECK_FALSE(theatre.host->finished());
  theatre.tick(20);
  CHECK(theatre.log.messages == std::vector<std::string>{"one: 0", "two: 0.05"});
  CHECK(theatre.host->finished());
}

TEST_CASE("a list ends with the first behavior that does not end with done") {
  Theatre theatre({lasting("one", "failed"), lasting("two", "done")});
  theatre.tick(30);
  CHECK(theatre.log.messages == std::vector<std::string>{"one: 0"});
  CHECK(theatre.host->finished());
  CHECK(theatre.host->behavior(0).outcome() == "failed");
  CHECK(theatre.host->behavior(1).outcome() == "");
}

TEST_CASE("a behavior that loops is stopped and reported, the others do not notice") {
  const std::string loops =
      behavior("bad", "k.state 'a' { during = function(m, s) if s.time_s > 0.015 then while true do end end end }");
  const std::string moves = behavior("good", "k.state 'a' { during = function(m) m.posture:set_gains('stiff') end }");
  Theatre theatre({loops, moves}, {0, 1});
  theatre.tick(10);
  CHECK(theatre.log.errors == 1);
  CHECK(theatre.log.joined().find("behaviors/b0.lua:2: instruction budget exceeded") == 0);
  CHECK(theatre.host->behavior(0).failed());
  CHECK_FALSE(theatre.host->behavior(1).failed());
  CHECK(theatre.sender.sent() == 10 * 12);
}

TEST_CASE("each behavior's commands are a transaction of their own") {
  const std::string moves = behavior("good", "k.state 'a' { enter = function(m) m.posture:set_gains('stiff') end }");
  Theatre theatre({moves, moves}, {0, 1});
  theatre.applying = false;
  theatre.tick(1);
  CHECK(theatre.sender.last_sequence() == 2);
  CHECK(theatre.queue.peek(0).count == 12);
  CHECK(theatre.queue.peek(13).sequence == 2);
}

TEST_CASE("all files that are wrong are told at once, and nothing is played") {
  try {
    const Theatre theatre({"local x = = 1", lasting("good", "done"), "y = 1"});
    FAIL("loaded");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 2);
    CHECK(error.problems()[0].file == "behaviors/b0.lua");
    CHECK(error.problems()[1].file == "behaviors/b2.lua");
  }
}

TEST_CASE("an error is reported once, with its line and the stack") {
  Theatre theatre({behavior(
      "bad", "k.state 'a' { during = function()\nlocal function inner() error('broken') end\ninner() end }")});
  theatre.tick(5);
  CHECK(theatre.log.errors == 1);
  CHECK(theatre.log.joined().find("behaviors/b0.lua:3: broken\nstack traceback:") == 0);
  CHECK(theatre.log.joined().find("behaviors/b0.lua:4: in function") != std::string::npos);
}

TEST_CASE("no address of memory, which differs from run to run, is told with an error") {
  for (const char* way : {"during = function() table.sort({ 1, 2 }, function() error('broken') end) end",
                          "run = function() table.sort({ 1, 2 }, function() error('broken') end) end"}) {
    Theatre theatre({behavior("bad", "k.state 'a' { " + std::string(way) + " }")});
    theatre.tick(5);
    const std::string said = theatre.log.joined();
    CHECK_MESSAGE(said.find("[C]:") != std::string::npos, said);
    CHECK_MESSAGE(said.find("0x") == std::string::npos, said);
    CHECK_MESSAGE(said.find("in function <behaviors/b0.lua:2>", said.find("[C]:")) != std::string::npos, said);
  }
}

TEST_CASE("stop leaves what plays") {
  Theatre theatre({behavior("one", "exit = function(m) m.posture:set_gains('soft') end, k.state 'a' {}")});
  theatre.tick(2);
  theatre.host->order({.kind = PlayOrder::Kind::stop});
  theatre.tick(1);
  CHECK(theatre.sender.sent() == 12);
  CHECK(theatre.host->finished());
}

TEST_CASE("the same seed plays the same commands, another seed others") {
  const auto played = [](std::uint64_t seed) {
    Stage stage(
        "local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' { during = function(m)\n"
        "local pose = {} for joint in pairs(k.pose 'stand') do if not joint:find 'ankle_roll' then pose[joint] = "
        "math.random() end end\n"
        "m.posture:move(pose, { time_s = 0.1 }) end } }",
        {}, seed);
    stage.tick(50);
    std::vector<double> values;
    for (const Command& command : stage.applied) values.push_back(command.value);
    return values;
  };
  CHECK(played(7).size() == 50 * 13);
  CHECK(played(7) == played(7));
  CHECK(played(7) != played(8));
}
