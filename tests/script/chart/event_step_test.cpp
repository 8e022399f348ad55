// The steps of a tick: one without events, then one for each event that is taken, up to a bound; and what becomes of
// the events that nobody takes.
#include <doctest/doctest.h>

#include "script/fixture.h"

namespace event_step_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string head = "local k = require 'kadans'\nlocal function log(text) return function() print(text) end end\n";

long told(const Stage& stage, const std::string& part) {
  return std::ranges::count_if(stage.log.messages,
                               [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("events that are emitted on the way are taken in the same tick, in their order") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { { when = function(s) return s.time_s >= 0.01 end, to = 'b' } },
    k.state 'b' { enter = function(m) print 'b' m:emit 'one' m:emit 'two' end, { on = 'one', to = 'c' } },
    k.state 'c' { enter = function(m) print 'c' m:emit 'three' end, { on = 'three', to = 'x' }, { on = 'two', to = 'd' } },
    k.state 'd' { enter = log 'd', { on = 'three', to = 'e' } },
    k.state 'e' { enter = log 'e' }, k.state 'x' { enter = log 'x' } })");
  stage.tick(2);
  CHECK(stage.said() == "b\nc\nd\ne\n");
  CHECK(stage.behavior->events_unhandled() == 0);
}

TEST_CASE("guards and times without an event are looked at once a tick, whatever the events do") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { { on = 'go', to = 'b' } },
    k.state 'b' { enter = function(m) print 'b' m:emit 'on' end, { to = 'x' }, { after = 0, to = 'x' }, { on = 'on', to = 'c' } },
    k.state 'c' { enter = log 'c', always = { { when = function() return true end, to = 'd' } } },
    k.state 'd' { enter = log 'd' }, k.state 'x' { enter = log 'x' } })");
  stage.tick();
  CHECK(stage.behavior->post("go"));
  stage.tick();
  CHECK(stage.said() == "b\nc\n");
  stage.tick();
  CHECK(stage.said() == "b\nc\nd\n");
}

TEST_CASE("an event waits until the end of its tick for a state that takes it") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a', k.state 'a' { { on = 'first', to = 'b' } },
    k.state 'b' { { on = 'early', to = 'c' } }, k.state 'c' {} })");
  stage.tick();
  CHECK(stage.behavior->post("early"));
  CHECK(stage.behavior->post("first"));
  stage.tick();
  CHECK(stage.behavior->state() == "c");
  CHECK(stage.behavior->events_unhandled() == 0);
}

TEST_CASE("an event that nothing takes in its tick is dropped, counted, and told once") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a', k.state 'a' { { after = 1, on = 'go', to = 'b' } },
    k.state 'b' { { on = 'back', to = 'a' } } })");
  stage.tick();
  for (int i = 0; i < 3; ++i) {
    CHECK(stage.behavior->post("back"));
    stage.tick();
  }
  CHECK(stage.behavior->post("go"));
  stage.tick();
  CHECK(stage.behavior->state() == "a");
  CHECK(stage.behavior->events_unhandled() == 4);
  CHECK(told(stage, "event 'back' was dropped") == 1);
  CHECK(told(stage, "event 'go' was dropped") == 1);
  stage.tick(2);
  CHECK(stage.behavior->events_unhandled() == 4);
}

TEST_CASE("events that lead to each other end with the 16th step of the tick, told once with a line") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a', during = log 'during', vars = { n = 0 },
    k.state 'a' { enter = function(m) m.vars.n = m.vars.n + 1 m:emit 'go' end,
      { on = 'go', to = 'b' }, { after = 0.01, to = 'b' } },
    k.state 'b' { enter = function(m) m.vars.n = m.vars.n + 1 m:emit 'back' end, exit = function(m) print(m.vars.n) end,
      { on = 'back', to = 'a' }, { after = 0.01, to = 'a' } } })");
  stage.tick();
  CHECK(stage.log.transitions.size() == 15);  // the first step entered
  CHECK(stage.said().ends_with("during\n"));
  CHECK(told(stage, "t: during") == 1);
  stage.tick(5);
  CHECK(stage.log.transitions.size() == 15 + 5 * 16);
  CHECK(stage.behavior->events_unhandled() == 6);
  CHECK(told(stage, "all 16 steps") == 1);
  CHECK(told(stage, "behaviors/test.lua:5:") == 1);
  CHECK_FALSE(stage.behavior->failed());
}

TEST_CASE("a guard beside an event sees what the step before changed") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a', vars = { ready = false },
    k.state 'a' { { on = 'go', when = function(_, m) return m.vars.ready end, to = 'b' },
                  { on = 'ready', action = function(m) m.vars.ready = true end, to = 'a' } },
    k.state 'b' {} })");
  stage.tick();
  CHECK(stage.behavior->post("go"));
  CHECK(stage.behavior->post("ready"));
  stage.tick();
  CHECK(stage.behavior->state() == "b");
}

TEST_CASE("during and run come once, after the last step, and what they emit is for the next tick") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { during = log 'a', { on = 'go', to = 'b' } },
    k.state 'b' { enter = function(m) m:emit 'on' end, during = log 'b', run = log 'run b', { on = 'on', to = 'c' } },
    k.state 'c' { during = function(m) print 'c' m:emit 'off' end, run = log 'run c', { on = 'off', to = 'd' } },
    k.state 'd' { during = log 'd' } })");
  stage.tick();
  CHECK(stage.behavior->post("go"));
  stage.tick();
  CHECK(stage.said() == "a\nc\nrun c\n");
  CHECK(stage.behavior->state() == "c");
  stage.tick();
  CHECK(stage.said() == "a\nc\nrun c\nd\n");
}

TEST_CASE("an outer after comes when it is due, whatever inner states do") {
  const auto ends_at = [](const std::string& inner) {
    Stage stage(head + "return k.behavior 't' { initial = 'a', k.state 'a' { initial = 'i', " + inner +
                ", { after = 0.5, to = 'late' } }, k.final 'late' { enter = function(_, s) print(s.time_s) end } }");
    stage.play(200);
    return stage.said();
  };
  CHECK(ends_at("k.state 'i' { { after = 0.01, to = 'i' } }") == "0.51\n");
  CHECK(ends_at("k.state 'i' { { to = 'j' } }, k.state 'j' { { to = 'i' } }") == "0.51\n");
  CHECK(ends_at("k.state 'i' { always = { { when = function() return true end, to = 'j' } } }, k.state 'j' { "
                "always = { { when = function() return true end, to = 'i' } } }") == "0.51\n");
  CHECK(ends_at("k.parallel 'i' { k.region 'l' { k.state 'x' { { to = 'x' } } }, k.region 'r' { k.state 'y' {} } }") ==
        "0.51\n");
  CHECK(ends_at("k.parallel 'i' { k.region 'l' { k.state 'x' { { to = 'x' } } }, k.region 'r' { k.state 'y' { { after "
                "= 0.3, to = 'late' } } } }") == "0.31\n");
}

TEST_CASE("an inner transition still goes before an outer after that is due in the same tick") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { { after = 0.05, to = 'late' }, k.state 'i' { { when = function(s) return s.time_s >= 0.05 end, to = 'good' } } },
    k.state 'late' {}, k.state 'good' {} })");
  stage.tick(10);
  CHECK(stage.behavior->state() == "good");
}

TEST_CASE("an outer after that was passed over waits for its guard, and begins anew with its state") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { initial = 'i', k.state 'i' { { to = 'i' } },
      { after = 0.02, when = function(s) return s.time_s >= 0.05 end, to = 'b' } },
    k.state 'b' { enter = function(_, s) print('b', s.time_s) end, { after = 0.01, to = 'a' } } })");
  stage.tick(11);
  CHECK(stage.said() == "b 0.05\nb 0.09\n");
}

TEST_CASE("guards and actions read the event's name and a copy of its data, and s.event is empty elsewhere") {
  Stage stage(head + R"(local given = { distance_m = 1, at = { x = 2 } }
    return k.behavior 't' { initial = 'a',
    k.state 'a' { enter = function(m) m:emit('seen', given) given.distance_m = 9 m:emit('seen', { distance_m = 3 }) end,
      { on = 'seen', when = function(s) return s.event.data.distance_m > 2 end,
        action = function(m, s) print(s.event.name, s.event.data.distance_m) end, to = 'b' } },
    k.state 'b' { { on = 'seen', action = function(m, s) print(s.event.name, s.event.data.at.x) end, to = 'c' } },
    k.state 'c' { enter = function(m) m:emit('bare') end,
      { on = 'bare', when = function(s) return s.event.data == nil end, to = 'd' } },
    k.state 'd' { enter = function(m, s) print('in', s.event.name) end, during = function(m, s) print(s.event.name, s.event.data) end } })");
  stage.tick();
  CHECK(stage.behavior->error().text() == "");
  CHECK(stage.said() == "seen 3\nseen 2\nin bare\nnil nil\n");
}

TEST_CASE("data of an event is a bounded table of plain data") {
  const auto emits = [](const std::string& data) {
    Stage stage(head +
                "local t = {} for i = 1, 65 do t[i] = i end local deep = { { { { { } } } } }\n"
                "return k.behavior 't' { k.state 'a' { enter = function(m) m:emit('go', " +
                data + ") end, { on = 'go', to = 'a', after = 9 } } }");
    stage.tick();
    return stage.behavior->error().text();
  };
  CHECK(emits("nil") == "");
  CHECK(emits("{}") == "");
  CHECK(emits("5").ends_with("the data of an event is a table { name = value }, not a number"));
  CHECK(emits("{ print }").ends_with("an event's data is plain data, not a function"));
  CHECK(emits("{ [true] = 1 }").ends_with("an event's data is plain data, not a boolean"));
  CHECK(emits("t").ends_with("an event's data has more than 64 fields"));
  CHECK(emits("deep").ends_with("an event's data is nested too deeply"));
  CHECK(emits("{ x = string.rep('x', 257) }").ends_with("a text in an event's data is longer than 256 characters"));
}

TEST_CASE("a transition may have several events") {
  Stage stage(head + R"(return k.behavior 't' { initial = 'a',
    k.state 'a' { { on = { 'one', 'two' }, action = function(_, s) print(s.event.name) end, to = 'b' } },
    k.state 'b' { { on = { 'one', 'two' }, action = function(_, s) print(s.event.name) end, to = 'a' } } })");
  stage.tick();
  CHECK(stage.behavior->post("two"));
  CHECK(stage.behavior->post("one"));
  stage.tick();
  CHECK(stage.said() == "two\none\n");
  const auto refused = [](const std::string& on) {
    return load_error("local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ on = " + on +
                      ", to = 'a' } } }");
  };
  CHECK(refused("5").find("'on' must be an event's name or a list of names, not a number") != std::string::npos);
  CHECK(refused("{ 'x', 5 }").find("'on' must be an event's name or a list of names, not a list with a number") !=
        std::string::npos);
  CHECK(refused("{}").find("'on' lists 1 to 32 events: on = { \"a\", \"b\" }") != std::string::npos);
}

}  // namespace event_step_test
