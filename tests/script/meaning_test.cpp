// What the description of behaviors says, sentence by sentence, where chart_test and event_test do not say it; and the
// order of SCXML where the description is silent.
#include <doctest/doctest.h>

#include "script/fixture.h"

namespace meaning_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string head =
    "local k = require 'kadans'\nlocal function log(text) return function() print(text) end end\n"
    "local function at(time_s) return function(s) return s.time_s >= time_s - 1e-9 end end\n";

// What the behavior prints, in one line.
std::string played(const std::string& text, int ticks) {
  Stage stage(head + text);
  stage.play(ticks);
  INFO(stage.behavior->error().text());
  CHECK_FALSE(stage.behavior->failed());
  std::string all = stage.said();
  for (char& c : all) c = c == '\n' ? ' ' : c;
  return all;
}

}  // namespace

TEST_CASE("an always in any region goes before what is no always") {
  CHECK(played(R"(return k.behavior 't' { initial = 'p', k.parallel 'p' {
      k.region 'l' { k.state 'l1' { { when = at(0.02), to = 'out' } } },
      k.region 'r' { initial = 'r1', always = { { when = at(0.02), to = 'r2' } },
        k.state 'r1' { exit = log 'r1-' }, k.state 'r2' { enter = log 'r2' } } },
    k.state 'out' { enter = log 'out' } })",
               4) == "r1- r2 out ");
}

TEST_CASE("of two regions that want to leave the parallel the first listed does") {
  CHECK(played(R"(return k.behavior 't' { initial = 'p', k.parallel 'p' {
      k.region 'l' { k.state 'l1' { { to = 'x' } } }, k.region 'r' { k.state 'r1' { { to = 'y' } } } },
    k.state 'x' { enter = log 'x' }, k.state 'y' { enter = log 'y' } })",
               3) == "x ");
}

TEST_CASE("a transition further inside goes before one of the parallel around it, whichever is found first") {
  CHECK(played(R"(return k.behavior 't' { initial = 'p', k.parallel 'p' {
      k.region 'l' { k.state 'l1' {} }, k.region 'r' { initial = 'r1', k.state 'r1' { { to = 'r2' } },
        k.state 'r2' { enter = log 'r2' } }, { when = at(0.01), to = 'x' } },
    k.state 'x' { enter = log 'x' } })",
               3) == "r2 x ");
}

TEST_CASE("nested regions take a transition each in one tick, exits before actions before entries") {
  CHECK(played(R"(
    local function ring(a, b)
      return k.state(a) { exit = log(a .. '-'), { action = log(a .. '>'), to = b } }, k.state(b) { enter = log(b .. '+') }
    end
    local a, b = ring('a', 'b') local c, d = ring('c', 'd') local e, f = ring('e', 'f')
    return k.behavior 't' { k.parallel 'p' {
      k.region 'x' { k.parallel 'q' { k.region 'u' { initial = 'a', a, b }, k.region 'v' { initial = 'c', c, d } } },
      k.region 'y' { initial = 'e', e, f } } })",
               2) == "e- c- a- a> c> e> b+ d+ f+ ");
}

TEST_CASE("a transition to a state around its own leaves and enters that state") {
  CHECK(played(R"(return k.behavior 't' { k.state 'a' { enter = log 'a+', exit = log 'a-', initial = 'b',
      k.state 'b' { exit = log 'b-', { after = 0.02, to = 'a' } } } })",
               4) == "a+ b- a- a+ ");
}

TEST_CASE("a transition of a state to one inside it leaves and enters the outer one too") {
  CHECK(played(R"(return k.behavior 't' { k.state 'a' { enter = log 'a+', exit = log 'a-', initial = 'b',
      { after = 0.02, when = at(0.02), to = 'c' },
      k.state 'b' { exit = log 'b-' }, k.state 'c' { enter = log 'c+' } } })",
               4) == "a+ b- a- a+ c+ ");
}

TEST_CASE("a transition of the behavior itself leaves the states but not the behavior") {
  CHECK(
      played(
          R"(return k.behavior 't' { enter = log 'B+', exit = log 'B-', initial = 'a', { when = at(0.02), after = 0.02, to = 'b' },
      k.state 'a' { exit = log 'a-' }, k.state 'b' { enter = log 'b+', endless = true } })",
          3) == "B+ a- b+ ");
}

TEST_CASE("history is what was active when its state was left, not what was left inside it") {
  const auto back = [](const char* deep) {
    return played(
        std::string("return k.behavior 't' { initial = 'w', k.state 'w' { initial = 'a', k.history 'h' { deep = ")
            .append(deep)
            .append(R"( },
      k.state 'a' { enter = log 'a', { to = 'b' } },
      k.state 'b' { enter = log 'b', { to = 'h', when = at(0.05) } }, { when = at(0.03), after = 0.03, to = 'pause' } },
    k.state 'pause' { { after = 0.02, to = 'h' } } })"),
        6);
  };
  CHECK(back("false") == "a b b ");
  CHECK(back("true") == "a b b ");
}

TEST_CASE("history inside its own state, never left, leads to the default") {
  CHECK(played(R"(return k.behavior 't' { k.state 'w' { initial = 'a', k.history 'h' {},
      k.state 'a' { enter = log 'a', { when = at(0.01), after = 0.01, to = 'b' } },
      k.state 'b' { enter = log 'b', { to = 'h' } } } })",
               3) == "a b a ");
}

TEST_CASE("deep history restores every region, shallow history the parallel from its start") {
  const auto back = [](const char* deep) {
    return played(
        std::string("return k.behavior 't' { initial = 'w', k.state 'w' { initial = 'p', k.history 'h' { deep = ")
            .append(deep)
            .append(R"( }, k.parallel 'p' {
        k.region 'l' { initial = 'a', k.state 'a' { enter = log 'a', { to = 'b' } }, k.state 'b' { enter = log 'b' } },
        k.region 'r' { initial = 'c', k.state 'c' { enter = log 'c', { to = 'd' } }, k.state 'd' { enter = log 'd' } } },
      { after = 0.03, to = 'pause' } }, k.state 'pause' { enter = log '|', { to = 'h' } } })"),
        5);
  };
  CHECK(back("true") == "a c b d | b d ");
  CHECK(back("false") == "a c b d | a c ");
}

TEST_CASE("a history of a behavior itself would never remember and is refused") {
  CHECK(load_error(head + "return k.behavior 't' { initial = 'a', k.state 'a' {},\nk.history 'h' {} }")
            .find("behaviors/test.lua:5: k.history 'h' remembers a state that is left; a behavior is not") == 0);
}

TEST_CASE("exit runs on every way out, once, innermost first") {
  const std::string states =
      " exit = log 'B-', k.state 'o' { exit = log 'o-', initial = 'i', k.state 'i' { exit = log 'i-', ";
  const std::string outs = "i-\no-\nB-\n";
  const auto said_at_the_end = [&](const std::string& inner, const std::string& rest) {
    Stage stage(head + "return k.behavior 't' {" + states + inner + " } }, " + rest + " }");
    stage.play(5);
    return stage.said();
  };
  CHECK(said_at_the_end("{ to = 'end' }", "initial = 'o', k.final 'end' {}") == outs);
  CHECK(said_at_the_end("", "initial = 'o', always = { { when = at(0.02), to = 'end' } }, k.final 'end' {}") == outs);
  CHECK(said_at_the_end("during = function() error 'broken' end", "") == outs);
  CHECK(said_at_the_end("run = function(m) m:wait(0.01) error 'broken' end", "") == outs);
  CHECK(said_at_the_end("{ when = function() error 'broken' end, to = 'i' }", "") == outs);
  CHECK(said_at_the_end("{ action = function() error 'broken' end, to = 'i' }", "") == outs);  // 'i' is left before it
  Stage stopped(head + "return k.behavior 't' {" + states + " } } }");
  stopped.tick(2);
  stopped.behavior->stop(stopped.snapshot, stopped.sender);
  CHECK(stopped.said() == outs);
  Stage reloaded(head + "return k.behavior 't' {" + states + " } } }");
  reloaded.tick(2);
  reloaded.scripts.write("behaviors/test.lua", head + "return k.behavior 't' { k.state 'new' {} }");
  CHECK(reloaded.behavior->reload(reloaded.snapshot, reloaded.sender) == Behavior::Reload::taken);
  CHECK(reloaded.said() == "i-\no-\nreloaded behaviors/test.lua\n");  // the behavior itself stays
}

TEST_CASE("an exit that raises keeps no other from running, and what those ask for is sent") {
  Stage stage(head + R"(return k.behavior 't' { exit = function(m) print 'B-' m.posture:set_gains 'soft' end,
    k.state 'o' { exit = function() print 'o-' error 'second' end,
      k.state 'i' { exit = function() print 'i-' error 'first' end } } })");
  stage.tick(2);
  stage.behavior->stop(stage.snapshot, stage.sender);
  CHECK(stage.said() == "i-\no-\nB-\n");
  CHECK(stage.behavior->error().text() == "behaviors/test.lua:6: first");
  CHECK(stage.sender.sent() == 12);
}

TEST_CASE("a state entered and left keeps nothing of before: its time, its run and its end begin anew") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', k.state 'a' { initial = 'x', exit = log 'a-',
      k.state 'x' { run = function(m) print('run', m.time_s) m:wait(0.02) end, { on = 'run.done', to = 'f' } }, k.final 'f' {},
      { on = 'done', to = 'a' } } })",
               9) == "run 0 a- run 0 a- run 0 ");
}

TEST_CASE("a called behavior that goes on from its final state is not at its end") {
  Stage stage(head + "return k.behavior 't' {}");
  stage.scripts.write("behaviors/lib/called.lua", head + R"(return k.behavior 'called' { initial = 'f',
    always = { { when = at(0.01), to = 'on' } }, k.final 'f' { outcome = 'early' }, k.state 'on' { enter = log 'on' } })");
  const auto file = stage.scripts.write("behaviors/caller.lua", head + R"(return k.behavior 'caller' { initial = 'a',
    k.state 'a' { k.call 'called', { on = 'early', when = at(0.03), to = 'b' } }, k.state 'b' { enter = log 'wrong' } })");
  stage.behavior = std::make_unique<Behavior>(Behavior::Settings{.root = stage.scripts.root, .file = file},
                                              stage.robot.catalog, stage.log);
  stage.tick(8);
  CHECK(stage.said() == "event 'early' was dropped: no transition took it in its tick (told once)\non\n");
}

TEST_CASE("every function of a tick sees the same snapshot, and the tick after it the next") {
  CHECK(played(R"(local function look(name) return function(m, s) print(name, s.tick, s.time_s) end end
    return k.behavior 't' { during = look 'during', initial = 'a', k.state 'a' { exit = look 'exit',
        { when = function(s) print('when', s.tick, s.time_s) return true end, action = look 'action', to = 'b' } },
      k.state 'b' { enter = look 'enter', run = function(m, s) look 'run' (m, s) m:wait(0) look 'run' (m, s) end } })",
               3) ==
        "during 0 0 when 10 0.01 exit 10 0.01 action 10 0.01 enter 10 0.01 during 10 0.01 run 10 0.01 "
        "during 20 0.02 run 20 0.02 ");
}

TEST_CASE("a part of the snapshot that is read late, or was kept from earlier, shows the numbers of the present tick") {
  Stage stage(head + R"(local kept
    return k.behavior 't' { k.state 'a' { enter = function(m, s) kept = s.joints end, during = function(m, s)
      if s.tick >= 20 then print(kept.l_knee.position_rad, s.joints.l_knee.velocity_rad_s, s.base.height_m) end
      if s.tick == 40 then for key, value in pairs(s.support) do print(key, value) end end end } })");
  for (int i = 0; i < 5; ++i) {
    stage.snapshot.joints.joints[3] = {.position_rad = i / 8.0, .velocity_rad_s = -i / 8.0, .effort_Nm = 0};
    stage.snapshot.status.base.height_m = i;
    stage.snapshot.status.support.force_N = 10.0 * i;
    stage.tick();
  }
  CHECK(stage.said() == "0.25 -0.25 2\n0.375 -0.375 3\n0.5 -0.5 4\ncop_x_m 0\ncop_y_m 0\nforce_N 40\n");
}

TEST_CASE("a guard is asked at most once in a tick, however many regions it concerns") {
  CHECK(
      played(
          R"(return k.behavior 't' { k.parallel 'p' { k.region 'l' { k.state 'a' {} }, k.region 'r' { k.state 'b' {} },
      { when = function(s) print 'asked' return false end, to = 'p' } } })",
          3) == "asked asked ");
}

TEST_CASE("what a guard emits is seen in the same tick, which ends all the same") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', k.state 'a' { enter = function(m) m:emit 'other' end,
      { when = function(s, m) m:emit 'go' return false end, to = 'a' },
      { on = 'go', to = 'b' } }, k.state 'b' { { on = 'other', to = 'a' }, enter = function(m, s) print(s.tick) end } })",
               5) == "event 'other' was dropped: no transition took it in its tick (told once) 10 ");
}

TEST_CASE("the bounded event queue takes 32, and events that no state takes are counted") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', k.state 'a' {}, k.state 'b' { { on = 'go', to = 'a' } } }");
  stage.tick();
  int taken = 0;
  for (int i = 0; i < 40; ++i) taken += stage.behavior->post("go") ? 1 : 0;
  CHECK(taken == 32);
  stage.tick();
  CHECK(stage.behavior->events_unhandled() == 32);
  CHECK(stage.behavior->state() == "a");
}

TEST_CASE("during runs before the coroutines, and those in the order of their states") {
  CHECK(played(R"(return k.behavior 't' { run = log 'B', during = log 'B.', k.parallel 'p' {
      k.region 'l' { k.state 'a' { run = log 'a', during = log 'a.' } },
      k.region 'r' { k.state 'b' { run = log 'b', during = log 'b.' } } } })",
               1) == "B. a. b. B a b ");
}

TEST_CASE("run is left with its state, wherever it waits: nothing of it runs again") {
  CHECK(played(R"(return k.behavior 't' { initial = 'a', k.state 'a' {
      run = function(m) local ok = pcall(function() m:wait(0.05) end) print('back', ok) end,
      exit = log 'a-', { after = 0.02, to = 'b' } }, k.state 'b' { endless = true } })",
               20) == "a- ");
}

TEST_CASE("a transition is logged with the time of its tick, between behaviors too") {
  struct Times final : LineSink {
    void tell(const Line& line) override {
      if (const Transition* made = line.transition; made != nullptr)
        told += made->behavior + std::to_string(made->time_ns) + made->why;
    }
    std::string told;
  };
  Stage stage(on_enter(""));
  Times times;
  BehaviorLog log{&times};
  const auto file = stage.scripts.write(
      "behaviors/timed.lua", head +
                                 "return k.behavior 't' { initial = 'a', k.state 'a' { { after = 0.03, to = 'b' } }, "
                                 "k.state 'b' { endless = true } }");
  Behavior behavior({.root = stage.scripts.root, .file = file}, stage.robot.catalog, log);
  for (; stage.snapshot.time_ns < 60'000'000; stage.snapshot.time_ns += 10'000'000) {
    (void)behavior.tick(stage.snapshot, stage.sender);
  }
  CHECK(times.told == "t30000000after");
}

TEST_CASE("a chart that would take memory outside the script's is refused at its line") {
  const std::string start = "local k = require 'kadans'\nlocal t = {}\nfor i = 1, 20000 do t[i] = ";
  CHECK(load_error("local k = require 'kadans'\nreturn k.behavior 't' { k.state(('x'):rep(65)) {} }")
            .find("behaviors/test.lua:2: k.state: a name has at most 64 characters") == 0);
  CHECK(load_error("local k = require 'kadans'\nlocal one = { to = 'a' }\nlocal t = { initial = 'a', k.state 'a' {} }\n"
                   "for i = 2, 20000 do t[i] = one end\nreturn k.behavior 't' (t)")
            .find("behaviors/test.lua:5: more than 16000 transitions") == 0);
  CHECK(
      load_error(
          "local k = require 'kadans'\nreturn k.behavior 't' {\nk.state 'a' { { to = 'a', why = ('x'):rep(60000) } } }")
          .find("'why' is longer than 256 characters") != std::string::npos);
  CHECK(load_error("local k = require 'kadans'\nk.params { x = { 1,\ndoc = ('x'):rep(60000) } }")
            .find("behaviors/test.lua:3: 'doc' is longer than 512 characters") == 0);
  CHECK(load_error("local k = require 'kadans'\nfor i = 1, 2000 do k.params { x = 1 } end")
            .find("behaviors/test.lua:2: more than 1000 parameters") == 0);
}

}  // namespace meaning_test
