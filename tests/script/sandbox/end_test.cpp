// The ends of states as events: whom they reach, in which order, and what takes them back.
#include <doctest/doctest.h>

#include "script/fixture.h"

namespace end_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string head = R"(local k = require 'kadans'
local function log(text) return function() print(text) end end
local function at(time_s) return function(s) return s.time_s >= time_s - 1e-9 end end
local function never() return false end
)";

std::string played(const std::string& text, int ticks = 10) {
  Stage stage(head + text);
  stage.play(ticks);
  INFO(stage.behavior->error().text());
  CHECK_FALSE(stage.behavior->failed());
  return stage.said();
}

struct Caller {
  Caller(const std::string& text, const std::string& called) {
    stage.scripts.write("behaviors/lib/called.lua", head + called);
    const auto file = stage.scripts.write("behaviors/caller.lua", head + text);
    stage.behavior = std::make_unique<Behavior>(Behavior::Settings{.root = stage.scripts.root, .file = file},
                                                stage.robot.catalog, stage.log);
  }
  Stage stage{on_enter("")};
};

}  // namespace

TEST_CASE("the end of a state reaches the nearest state around it that waits for it") {
  const auto reaches = [](const std::string& inner, const std::string& middle) {
    return played(
        "return k.behavior 't' { initial = 'a', k.state 'a' { initial = 'b', k.state 'b' { k.state 'c' {\n"
        "initial = 'i', k.state 'i' { { to = 'f' } }, k.final 'f' { outcome = 'tired' }, " +
        inner + " }, " + middle +
        " }, { on = 'tired', to = 'far' } },\n"
        "k.state 'near' { enter = log 'near' }, k.state 'far' { enter = log 'far' } }");
  };
  CHECK(reaches("", "") == "far\n");
  CHECK(reaches("{ on = 'done', to = 'near' }", "") == "far\n");
  CHECK(reaches("{ on = 'tired', to = 'near' }", "") == "near\n");
  CHECK(reaches("{ on = 'tired', when = never, to = 'near' }", "") == "far\n");
  CHECK(reaches("", "{ on = 'tired', to = 'near' }") == "near\n");
}

TEST_CASE("the end of a state is an event once: later it counts no more") {
  Stage stage(
      head +
      R"(return k.behavior 't' { initial = 'a', k.state 'a' { initial = 'i', k.state 'i' { { to = 'f' } }, k.final 'f' {},
      { on = 'done', when = at(0.05), to = 'b' } }, k.state 'b' {} })");
  stage.tick(10);
  CHECK(stage.behavior->state() == "a.f");
  CHECK(stage.behavior->events_unhandled() == 1);
  CHECK(stage.said() == "event 'done' was dropped: no transition took it in its tick (told once)\n");
}

TEST_CASE("an end that nobody waits for is no event") {
  Stage stage(head + "return k.behavior 't' { initial = 'a', k.state 'a' { k.final 'f' {} } }");
  stage.tick(3);
  CHECK(stage.behavior->events_unhandled() == 0);
  CHECK(stage.said() == "");
}

TEST_CASE("ends wait in the order in which they came, behind what was emitted before") {
  const auto region = [](const std::string& name, const std::string& emitted) {
    return "k.region '" + name + "' { initial = 'in', k.state 'in' { initial = 'i', k.state 'i' { { to = 'f' } },\n" +
           "k.final 'f' { enter = function(m) m:emit '" + emitted + "' end }, { on = 'done', to = 'out' } },\n" +
           "k.state 'out' { enter = log '" + name + "' } },\n";
  };
  CHECK(played(
            "return k.behavior 't' { initial = 'p', k.parallel 'p' {\n" + region("left", "before") +
            region("right", "after") +
            "k.region 'x' { initial = 'a', k.state 'a' { { on = 'before', to = 'b' } },\n"
            "k.state 'b' { enter = log 'before', { on = 'after', to = 'c' } }, k.state 'c' { enter = log 'after' } } } "
            "}") == "before\nleft\nafter\nright\n");
}

TEST_CASE("an end is taken back when its state is left or goes on before the end was taken") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', k.state 'a' { initial = 'i',
      k.state 'i' { { to = 'f' } }, k.final 'f' { enter = function(m) m:emit 'go' end }, k.state 'on' { enter = log 'on' },
      { on = 'done', when = function(_, m) return m.vars.gone end, to = 'wrong' },
      { on = 'go', action = function(m) m.vars.gone = true end, to = 'on' } },
    vars = { gone = false }, k.state 'wrong' { enter = log 'wrong' } })") == "on\n");
}

TEST_CASE("a called behavior's end reaches the state that calls it and those around it, but not the caller's caller") {
  const std::string called =
      "return k.behavior 'called' { initial = 'i', k.state 'i' { { to = 'e' } }, k.final 'e' { outcome = 'lost' } }";
  Caller direct(
      "return k.behavior 'caller' { initial = 'a', k.state 'a' { k.state 'b' { k.call 'called' }, { on = "
      "'lost', to = 'x' } }, k.state 'x' { enter = log 'x' } }",
      called);
  direct.stage.tick(5);
  CHECK(direct.stage.said() == "x\n");
  Stage twice{on_enter("")};
  twice.scripts.write("behaviors/lib/called.lua", head + called);
  twice.scripts.write("behaviors/lib/between.lua",
                      head + "return k.behavior 'between' { k.state 'c' { k.call 'called' } }");
  const auto file = twice.scripts.write("behaviors/caller.lua",
                                        head +
                                            "return k.behavior 'caller' { initial = 'a', k.state 'a' { k.call "
                                            "'between', { on = 'lost', to = 'x' } }, k.state 'x' {} }");
  twice.behavior = std::make_unique<Behavior>(Behavior::Settings{.root = twice.scripts.root, .file = file},
                                              twice.robot.catalog, twice.log);
  twice.tick(5);
  CHECK(twice.behavior->state() == "a.between.c.called.e");
}

TEST_CASE("what is around a region hears how all regions ended, not how one of them did") {
  const std::string text = R"(return k.behavior 't' { initial = 'o', k.state 'o' { k.parallel 'p' {
    k.region 'l' { initial = 'in', k.state 'in' { initial = 'i', k.state 'i' { { when = at(0.02), to = 'f' } }, k.final 'f' {} }, k.final 'g' {} },
    k.region 'm' { initial = 'i', k.state 'i' { { when = at(0.03), to = 'f' } }, k.final 'f' { outcome = 'lost' } },
    k.region 'r' { initial = 'i', k.state 'i' { { when = at(0.05), to = 'f' } }, k.final 'f' {} } },
    { on = 'done', to = 'x' }, { on = 'lost', to = 'y' } },
    k.state 'x' { enter = log 'x' }, k.state 'y' { enter = function(_, s) print('y', s.time_s) end } })";
  CHECK(played(text) == "");  // region l does not end
  std::string ends = text;
  ends.replace(ends.find("k.final 'f' {} }, k.final 'g' {}"), 0, "{ on = 'done', to = 'g' }, ");
  CHECK(played(ends) == "y 0.05\n");
}

TEST_CASE("neither a script nor the outside can send the end of a state or of a run") {
  for (const std::string name : {"done", "run.done", "lost"}) {
    Stage stage(
        head + "return k.behavior 't' { initial = 'a', k.state 'a' { initial = 'i', during = function(m) m:emit '" +
        name +
        "' end,\nk.state 'i' { run = function(m) m:wait(9) end, { after = 9, to = 'f' }, { on = 'run.done', to = 'f' } "
        "},\n"
        "k.final 'f' { outcome = 'lost' }, k.final 'g' {}, { on = 'lost', to = 'b' }, { on = 'done', to = 'b' } }, "
        "k.state 'b' { enter = log 'forged' } }");
    stage.tick();
    CHECK_FALSE(stage.behavior->post(name));
    CHECK(stage.behavior->error().text() ==
          "behaviors/test.lua:5: '" + name +
              "' says how a state or a run ended, it cannot be emitted: give the event another name");
  }
}

TEST_CASE("the end of a parallel tells how each region ended") {
  CHECK(played(R"(return k.behavior 't' { initial = 'p', k.parallel 'p' {
    k.region 'l' { k.final 'f' {} }, k.region 'r' { initial = 'i', k.state 'i' { { to = 'f' } }, k.final 'f' { outcome = 'lost' } },
    { on = 'lost', when = function(s) return s.event.data.outcomes.l == 'done' end,
      action = function(_, s) print(s.event.name, s.event.data.outcomes.r) end, to = 'x' } },
    k.state 'x' {} })") == "lost lost\n");
}

}  // namespace end_test
