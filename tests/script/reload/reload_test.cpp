// Hot reload: what stays, what changes, and that a version that is not good never runs.
#include <cstdlib>

#include <doctest/doctest.h>

#include "script/behavior/behavior.h"
#include "script/fixture.h"

namespace reload_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

std::string chart(const std::string& body, const std::string& head = "") {
  return "local k = require 'kadans'\n" + head + "return k.behavior 'test' {\n" + body + "\n}\n";
}

// Saves a new text over the behavior's file and reloads.
Behavior::Reload reload(Stage& stage, const std::string& text, const std::string& file = "behaviors/test.lua") {
  stage.scripts.write(file, text);
  return stage.behavior->reload(stage.snapshot, stage.sender);
}

const char counting[] =
    "vars = { n = 0 }, initial = 'z', k.state 'z' { { after = 0.05, to = 'a' } },\n"
    "k.state 'a' { enter = function() print 'in a' end, exit = function() print 'out a' end,\n"
    "  during = function(m) m.vars.n = m.vars.n + 1 end, { after = 0.2, to = 'b' } },\n"
    "k.state 'b' { enter = function(m) print('b', m.vars.n) end }";

}  // namespace

TEST_CASE("a reload keeps the active state, its time and vars, and runs neither enter nor exit of what stays") {
  Stage stage(chart(counting));
  stage.tick(11);
  REQUIRE(reload(stage, chart(counting) + "-- another text\n") == Behavior::Reload::taken);
  CHECK(stage.behavior->state() == "a");
  stage.tick(16);
  CHECK(stage.said() == "in a\nreloaded behaviors/test.lua\nout a\nb 20\n");
  CHECK(stage.behavior->status().reloads == 1);
}

TEST_CASE("the new version's functions run from the next tick on") {
  Stage stage(chart("k.state 'a' { during = function() print 'old' end }"));
  stage.tick(2);
  CHECK(reload(stage, chart("k.state 'a' { during = function() print 'new' end }")) == Behavior::Reload::taken);
  stage.tick(2);
  CHECK(stage.said() == "old\nold\nreloaded behaviors/test.lua\nnew\nnew\n");
}

TEST_CASE("a file whose text is the same changes nothing, not even a coroutine") {
  const std::string text = chart("k.state 'a' { run = function(m) for i = 1, 5 do print(i) m:wait(0) end end }");
  Stage stage(text);
  for (int i = 0; i < 5; ++i) {
    stage.tick();
    CHECK(reload(stage, text) == Behavior::Reload::unchanged);
  }
  CHECK(stage.said() == "1\n2\n3\n4\n5\n");
}

TEST_CASE("run begins anew in a state that stays, but not when it was over, and motions under way go on") {
  const std::string text = chart(
      "k.parallel 'p' { k.region 'x' { k.state 'a' { run = function(m) print 'short' end } },\n"
      "k.region 'y' { k.state 'b' { run = function(m) print 'long' m.posture:move('lean', { time_s = 1 }):wait() end } "
      "} }");
  Stage stage(text);
  stage.tick(3);
  CHECK(reload(stage, text + "--") == Behavior::Reload::taken);
  stage.tick(3);
  CHECK(stage.said() == "short\nlong\nreloaded behaviors/test.lua\nlong\n");
  CHECK(stage.commands(CommandKind::cancel_motion) == 0);
}

TEST_CASE("a state that is gone is left by its own exit, and the initial state around it is entered") {
  Stage stage(
      chart("initial = 'o', k.state 'o' { exit = function() print 'out o' end, initial = 'a',\n"
            "k.state 'a' { { after = 0, to = 'b' } }, k.state 'b' { initial = 'c',\n"
            "exit = function() print 'out b' end, k.state 'c' { exit = function() print 'out c' end } } }"));
  stage.tick(3);
  REQUIRE(stage.behavior->state() == "o.b.c");
  CHECK(reload(stage, chart("initial = 'o', k.state 'o' { enter = function() print 'in o' end, initial = 'd',\n"
                            "k.state 'd' { enter = function() print 'in d' end } }")) == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(stage.said() == "out c\nout b\nreloaded behaviors/test.lua\nin d\n");
  CHECK(stage.behavior->state() == "o.d");
  CHECK(stage.log.transitions.back() == "o.b.c>o.d:reload");
}

TEST_CASE("a region that is new is entered, the others stay") {
  Stage stage(chart(
      "k.parallel 'p' { k.region 'x' { initial = 'a', k.state 'a' { { after = 0, to = 'b' } }, k.state 'b' {} } }"));
  stage.tick(3);
  CHECK(reload(stage,
               chart("k.parallel 'p' { k.region 'x' { initial = 'a', k.state 'a' { enter = function() print 'a' end "
                     "}, k.state 'b' { enter = function() print 'b' end } },\n"
                     "k.region 'y' { k.state 'c' { enter = function() print 'c' end } } }")) ==
        Behavior::Reload::taken);
  stage.tick(2);
  CHECK(stage.said() == "reloaded behaviors/test.lua\nc\n");
}

TEST_CASE("the shallow and the deep history and waiting events survive") {
  const std::string text = chart(
      "initial = 'o', k.state 'o' { initial = 'a', k.history 'h' { deep = true },\n"
      "k.state 'a' { { after = 0, to = 'b' } }, k.state 'b' { k.state 'c' {} }, { on = 'away', to = 'x' } },\n"
      "k.state 'x' { { on = 'back', to = 'h' } }");
  Stage stage(text);
  stage.tick(3);
  REQUIRE(stage.behavior->post("away"));
  stage.tick(1);
  REQUIRE(stage.behavior->state() == "x");
  REQUIRE(stage.behavior->post("back"));
  CHECK(reload(stage, text + "--") == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(stage.behavior->state() == "o.b.c");
}

TEST_CASE("vars of another version go through migrate, without it they start as declared") {
  const auto version = [](const std::string& head) {
    return chart(head + " k.state 'a' { during = function(m) print(m.vars.n, m.vars.more) end }");
  };
  Stage stage(version("version = 1, vars = { n = 7 },"));
  CHECK(reload(stage, version("version = 1, vars = { n = 8, more = 'x' },")) == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(reload(stage, version("version = 1, vars = { n = 9, more = 'y', z = 1 },")) == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(reload(stage, version("version = 3, vars = { n = 0 }, migrate = function(old, from) return { n = old.n * 10, "
                              "more = from } end,")) == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(reload(stage, version("version = 4, vars = { n = 1 },")) == Behavior::Reload::taken);
  stage.tick(1);
  std::string said;
  for (const std::string& line : stage.log.messages) {
    if (line.find("reloaded") == std::string::npos) said += line.substr(6) + ";";
  }
  CHECK(said == "8 x;8 x;80 1;1 nil;");
}

TEST_CASE("a motion kept in vars can still be asked after a reload, a function cannot be kept") {
  const auto keeps = [](const char* what) {
    return chart(std::string("k.state 'a' { enter = function(m) m.vars.kept = ") + what +
                 " end, during = function(m) if m.vars.kept.done then print 'arrived' m.vars.kept = { } end end }");
  };
  Stage stage(keeps("m.posture:move('lean', { time_s = 0.1 })"));
  stage.tick(3);
  CHECK(reload(stage, keeps("m.posture:move('lean', { time_s = 0.1 })") + "--") == Behavior::Reload::taken);
  stage.tick(12);
  CHECK(stage.said() == "reloaded behaviors/test.lua\narrived\n");

  Stage other(chart("k.state 'a' { enter = function(m) m.vars.f = function() end end }"));
  other.tick(2);
  CHECK(reload(other, chart("k.state 'a' {}")) == Behavior::Reload::refused);
  CHECK(other.said().find("vars hold a function") != std::string::npos);
  CHECK(reload(other, chart("version = 1, k.state 'a' {}")) == Behavior::Reload::taken);  // needs no vars of version 0
}

TEST_CASE("a state that became one of another kind is gone: it is left and the new one is entered") {
  const auto with = [](const std::string& b) {
    return chart("initial = 'a', k.state 'a' { enter = function() print 'in a' end, { after = 0, to = 'b' } },\n" + b);
  };
  Stage stage(with("k.state 'b' { exit = function() print 'out b' end, k.state 'x' {} }"));
  stage.tick(3);
  REQUIRE(stage.behavior->state() == "b.x");
  CHECK(reload(stage, with("k.parallel 'b' { k.region 'x' { k.state 'c' {} } }")) == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(stage.said() == "in a\nout b\nreloaded behaviors/test.lua\nin a\n");
  CHECK(stage.behavior->state() == "a");
}

TEST_CASE("a parameter that somebody changed keeps its value while it is declared and in range") {
  const auto with = [](const std::string& spec) {
    return chart("k.state 'a' { during = function() print(P.x) end }", "local P = k.params { x = " + spec + " }\n");
  };
  Stage stage(with("{ 1, min = 0, max = 10 }"));
  REQUIRE(stage.behavior->set_parameter("x", 5));
  stage.tick(1);
  CHECK(reload(stage, with("{ 2, min = 0, max = 6 }")) == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(reload(stage, with("{ 2, min = 0, max = 4 }")) == Behavior::Reload::taken);
  stage.tick(1);
  CHECK(reload(stage, with("{ 3, min = 0, max = 4 }")) == Behavior::Reload::taken);  // nobody changed the 2
  stage.tick(1);
  CHECK(stage.log.messages.back() == "test: 3");
  CHECK(stage.log.joined().find("5\nreloaded behaviors/test.lua\n5\nreloaded behaviors/test.lua\n2\n") == 0);
}

TEST_CASE("a version that is not good is refused with its line, and the old one goes on") {
  const std::string good = chart("k.state 'a' { during = function(m) print 'on' end }");
  const auto refused = [&](const std::string& text, const std::string& why) {
    CAPTURE(text);
    Stage stage(good);
    stage.tick(1);
    CHECK(reload(stage, text) == Behavior::Reload::refused);
    CHECK(reload(stage, text) == Behavior::Reload::refused);  // said once
    stage.tick(1);
    CHECK_MESSAGE(stage.said().find("on\nreload refused, the old version goes on: " + why) == 0, stage.said());
    CHECK(stage.said().rfind("\non\n") == stage.said().size() - 4);
    CHECK(stage.log.messages.size() == 3);
    CHECK(stage.log.errors == 0);
  };
  refused(good.substr(0, good.size() / 2), "behaviors/test.lua:3:");  // half written
  refused("", "behaviors/test.lua:1: the file must return k.behavior");
  refused(chart("k.state 'a' { { after = 1, to = 'b' } }"), "behaviors/test.lua:3: unknown state 'b'");
  refused(chart("controls = 'postur', k.state 'a' {}"), "behaviors/test.lua:3: unknown control set 'postur'");
  refused(chart("k.state 'a' {}", "while true do end\n"), "behaviors/test.lua:2: instruction budget exceeded");
  refused(chart("initial = 'a', k.state 'a' { { when = function(s)\nreturn s.base.pitch > 0 end, to = 'b' } }, k.state "
                "'b' {}"),
          "behaviors/test.lua:4: s.base has no 'pitch', did you mean 'pitch_rad'?");
  refused(chart("version = 2, migrate = function(old)\nreturn old.x.y end, k.state 'a' {}"), "behaviors/test.lua:4:");
  refused("return 5", "behaviors/test.lua:1: the file must return k.behavior");
}

TEST_CASE("guards that are tried command nothing, draw no random number and leave no trace in vars") {
  const std::string head = "initial = 'a', vars = { n = 0 }, k.state 'a' { ";
  const std::string tail = " }, k.state 'b' {}";
  const std::string last = "during = function(m) print(m.vars.n, math.random(1000)) end";
  Stage stage(chart(head + last + tail)), alone(chart(head + last + tail));
  stage.tick(2);
  CHECK(reload(stage, chart(head + last + ", { when = function(s, m) m.vars.n = m.vars.n + 1 math.random()\n" +
                            "m.posture:set_gains 'soft' return false end, after = 1, to = 'b' }" + tail)) ==
        Behavior::Reload::taken);
  CHECK(stage.sender.sent() == 0);
  stage.tick(1);
  alone.tick(3);
  CHECK(stage.log.messages.back() == alone.log.messages.back());
}

TEST_CASE("a module that a behavior requires counts as part of it") {
  Scripts scripts;
  Robot robot;
  Log log;
  CommandQueue queue;
  CommandSender sender(queue);
  Snapshot snapshot;
  scripts.write("behaviors/lib/words.lua", "return { word = 'old' }");
  const auto file = scripts.write("behaviors/test.lua", chart("k.state 'a' { during = function() print(w.word) end }",
                                                              "local w = require 'words'\n"));
  Behavior behavior({.root = scripts.root, .file = file}, robot.catalog, log);
  behavior.tick(snapshot, sender);
  scripts.write("behaviors/lib/words.lua", "return { word = = }");
  CHECK(behavior.reload(snapshot, sender) == Behavior::Reload::refused);
  scripts.write("behaviors/lib/words.lua", "return { word = 'new' }");
  CHECK(behavior.reload(snapshot, sender) == Behavior::Reload::taken);
  behavior.tick(snapshot, sender);
  CHECK(log.joined().find("old\nreload refused, the old version goes on: behaviors/lib/words.lua:1:") == 0);
  CHECK(log.messages.back() == "test: new");
}

TEST_CASE("a reload begins nothing that an error has stopped: neither what was not entered nor a run that raised") {
  const std::string told = "{ on = 'error', action = function() print 'told' end }";
  const std::string entered = chart("k.state 's' { initial = 'inner', run = function() print 'run' end, " + told +
                                    ",\nenter = function() error 'x' end,\n"
                                    "k.state 'inner' { enter = function() print 'inner' end } }");
  const std::string ran = chart("k.state 's' { run = function() print 'run' error 'x' end, " + told + " }");
  for (const std::string& text : {entered, ran}) {
    Stage stage(text);
    stage.tick(3);
    const std::string before = stage.said();
    REQUIRE(before.find("told\n") != std::string::npos);
    REQUIRE(reload(stage, text + "-- another text\n") == Behavior::Reload::taken);
    stage.tick(3);
    CHECK(stage.said() == before + "reloaded behaviors/test.lua\n");
  }
}

TEST_CASE("a parameter that was set back to its default stays so, though its behavior was played with another value") {
  const std::string text =
      chart("k.state 'a' { during = function() print(P.x) end }", "local P = k.params { x = 1 }\n");
  Stage stage(text);
  REQUIRE(stage.behavior->set_parameter("x", 5));
  REQUIRE(reload(stage, text + "-- 2\n") == Behavior::Reload::taken);
  REQUIRE(stage.behavior->set_parameter("x", 1));
  REQUIRE(reload(stage, text + "-- 3\n") == Behavior::Reload::taken);
  stage.tick();
  CHECK(stage.said().find("\n1\n") != std::string::npos);
}

}  // namespace reload_test
