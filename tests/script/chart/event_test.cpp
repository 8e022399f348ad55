// Events, coroutines of `run`, and behaviors that call behaviors.
#include <doctest/doctest.h>

#include "script/fixture.h"

namespace event_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string head = "local k = require 'kadans'\nlocal function log(text) return function() print(text) end end\n";

}  // namespace

TEST_CASE("events are seen in their order, one a step, and by every region that waits for them") {
  Stage stage(head + R"(return k.behavior 't' { k.parallel 'p' {
    k.region 'l' { initial = 'a', k.state 'a' { { on = 'go', to = 'b' } }, k.state 'b' { enter = log 'b', { on = 'on', to = 'c' } }, k.state 'c' { enter = log 'c' } },
    k.region 'r' { initial = 'd', k.state 'd' { { on = 'go', to = 'e' } }, k.state 'e' { enter = log 'e' } } } })");
  stage.tick();
  CHECK(stage.behavior->post("go"));
  CHECK(stage.behavior->post("on"));
  stage.tick();
  CHECK(stage.said() == "b\ne\nc\n");
  CHECK(stage.behavior->events_unhandled() == 0);
}

TEST_CASE("an event that nobody takes waits for the end of its tick, the next one is looked at first") {
  Stage stage(
      head +
      R"(return k.behavior 't' { initial = 'a', k.state 'a' { { on = 'go', to = 'b' } }, k.state 'b' { { on = 'back', to = 'a' } } })");
  stage.tick();
  CHECK(stage.behavior->post("back"));
  CHECK(stage.behavior->post("go"));
  stage.tick();
  CHECK(stage.behavior->state() == "a");  // by "go", then by "back"
  CHECK(stage.log.transitions.size() == 2);
  CHECK(stage.behavior->events_unhandled() == 0);
}

TEST_CASE("transitions without event are taken before an event, in the same tick") {
  Stage stage(
      head +
      R"(return k.behavior 't' { initial = 'a', k.state 'a' { { to = 'b' } }, k.state 'b' { { on = 'go', to = 'c' } }, k.state 'c' {} })");
  stage.tick();
  CHECK(stage.behavior->post("go"));
  stage.tick();
  CHECK(stage.log.transitions.size() == 2);
  CHECK(stage.behavior->state() == "c");
}

TEST_CASE("the event queue is bounded and refuses visibly") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', k.state 'a' { during = function(m) for _ = 1, 40 do\n"
              "local ok, why = m:emit('go') if not ok then print(why) return end end end, { when = function() return "
              "false end, on = 'go', to = 'b' } }, k.state 'b' {} }");
  stage.tick();
  CHECK(stage.said() == "queue_full\n");
  CHECK_FALSE(stage.behavior->post("nothing of this name"));
}

TEST_CASE("what a behavior emits on entering it sees in the same tick") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', k.state 'a' { enter = function(m) m:emit('go') end, { on = 'go', "
              "to = 'b' } }, k.state 'b' {} }");
  stage.tick();
  CHECK(stage.behavior->state() == "b");
}

TEST_CASE("run is a coroutine: it goes on tick by tick, waits in seconds, and its end is an event") {
  Stage stage(
      head +
      R"(return k.behavior 't' { initial = 'a', k.state 'a' { run = function(m, s) print(s.time_s) coroutine.yield() print(s.time_s)
    m:wait(0.05) print(s.time_s) end, { on = 'run.done', to = 'b' } }, k.state 'b' { enter = function(_, s) print(s.time_s) end } })");
  stage.play(20);
  CHECK(stage.said() == "0\n0.01\n0.06\n0.07\n");
}

TEST_CASE("run is cancelled when its state is left, and begins anew when it is entered again") {
  Stage stage(
      head +
      R"(return k.behavior 't' { initial = 'a', k.state 'a' { run = function(m) print 'start' m:wait(1) print 'never' end,
    { after = 0.03, to = 'b' } }, k.state 'b' { { after = 0.03, to = 'a' } } })");
  stage.tick(11);
  CHECK(stage.said() == "start\nstart\n");
}

TEST_CASE("pcall inside run may hold a wait") {
  Stage stage(
      head +
      R"(return k.behavior 't' { k.state 'a' { run = function(m) print(pcall(function() m:wait(0.02) return 'ok' end)) end } })");
  stage.tick(5);
  CHECK(stage.said() == "true ok\n");
}

TEST_CASE("an error inside run is reported with the line and the stack of the coroutine") {
  Stage stage(head +
              "return k.behavior 't' { k.state 'a' { run = function(m)\nm:wait(0.02)\nlocal function "
              "inner()\nerror('broken') end\ninner() end } }");
  stage.tick(5);
  CHECK(stage.behavior->error().text() == "behaviors/test.lua:6: broken");
  CHECK(std::string(stage.behavior->error().traceback.data()).find("behaviors/test.lua:7:") != std::string::npos);
}

TEST_CASE("after an error the states are left, innermost first, and what they ask for is sent") {
  Stage stage(head + R"(return k.behavior 't' { exit = function(m) print('B-') m.posture:set_gains('soft') end,
    k.state 'a' { exit = log 'a-', during = function(m, s) m.posture:set_gains('stiff') if s.time_s >= 0.02 then error('broken', 0) end end } })");
  stage.play(10);
  CHECK(stage.said() == "a-\nB-\n");
  CHECK(stage.behavior->error().text() == "behaviors/test.lua:4: broken");
  CHECK(stage.applied.back().value == 20.0);
  CHECK(stage.applied[0].count == 12);
}

TEST_CASE("stop leaves all states") {
  Stage stage(head + "return k.behavior 't' { exit = log 'B-', k.state 'a' { exit = log 'a-' } }");
  stage.tick();
  stage.behavior->stop(stage.snapshot, stage.sender);
  CHECK(stage.said() == "a-\nB-\n");
  CHECK(stage.behavior->finished());
}

namespace {

struct Caller {
  explicit Caller(const std::string& text, const std::string& called) {
    stage.scripts.write("behaviors/lib/called.lua", head + called);
    const auto file = stage.scripts.write("behaviors/caller.lua", head + text);
    stage.behavior = std::make_unique<Behavior>(Behavior::Settings{.root = stage.scripts.root, .file = file},
                                                stage.robot.catalog, stage.log);
  }
  Stage stage{on_enter("")};
};

std::string refused_call(const std::string& text, const std::string& called) {
  try {
    const Caller caller(text, called);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a behavior is called with arguments, has vars of its own, and its outcome is an event for the caller") {
  Caller caller(
      R"(return k.behavior 'caller' { vars = { n = 'mine' }, initial = 'a',
      k.state 'a' { k.call 'called' { distance_m = 2 }, { on = 'done', to = 'x' }, { on = 'lost', to = 'y' } },
      k.state 'x' {}, k.state 'y' { enter = function(m) print(m.vars.n) end } })",
      R"(return k.behavior 'called' { args = { distance_m = 1, speed = 3 }, vars = { n = 'its' }, initial = 'go',
      k.state 'go' { enter = function(m) print(m.vars.n, m.args.distance_m, m.args.speed, m.name) m.vars.n = 'changed' end, { after = 0.03, to = 'end' } },
      k.final 'end' { outcome = 'lost' } })");
  caller.stage.play(20);
  CHECK(caller.stage.said() == "its 2 3 called\nmine\n");
  CHECK(caller.stage.behavior->state() == "y");
}

TEST_CASE("a behavior that is called again starts with its declared vars") {
  Caller caller("return k.behavior 'caller' { k.state 'a' { k.call 'called', { on = 'done', to = 'a' } } }",
                "return k.behavior 'called' { vars = { list = {} }, initial = 'b', k.state 'b' { enter = function(m) "
                "m.vars.list[#m.vars.list + 1] = 1 print(#m.vars.list) end, { to = 'c' } }, k.final 'c' {} }");
  caller.stage.tick(3);
  CHECK(caller.stage.said() == "1\n1\n1\n");
}

TEST_CASE("a region may call a behavior") {
  Caller caller(
      "return k.behavior 'caller' { initial = 'p', k.parallel 'p' { k.region 'l' { k.call 'called' }, k.region 'r' { "
      "k.call 'called' }, { on = 'done', to = 'z' } }, k.final 'z' {} }",
      "return k.behavior 'called' { initial = 'b', k.state 'b' { { after = 0.02, to = 'c' } }, k.final 'c' {} }");
  caller.stage.play(20);
  CHECK(caller.stage.behavior->outcome() == "done");
}

TEST_CASE("calls that cannot work are refused at their line") {
  const std::string called = "return k.behavior 'called' { args = { far = 1 }, controls = 'gesture', k.final 'c' {} }";
  CHECK(refused_call("return k.behavior 'caller' {\nk.state 'a' { k.call 'cold' } }", called)
            .find("behaviors/caller.lua:4: k.call: no module 'cold'") == 0);
  CHECK(refused_call("return k.behavior 'caller' {\nk.state 'a' { k.call 'called' { near = 1 } } }", called)
            .find("behaviors/caller.lua:4: behavior 'called' takes no argument 'near'") == 0);
  CHECK(refused_call("return k.behavior 'caller' {\nk.state 'a' { k.call 'called' } }",
                     "return k.behavior 'called' { k.state 'x' { k.call 'called' } }")
            .find("does 'called' call itself?") != std::string::npos);
  CHECK(refused_call("return k.behavior 'caller' {\nk.state 'a' { k.call 'called' } }", "local x = = 1")
            .find("behaviors/lib/called.lua:3:") == 0);
}

}  // namespace event_test
