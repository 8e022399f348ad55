// All active states of a behavior: told by path, as signals and in conditions; and why transitions wait.
#include <doctest/doctest.h>

#include "script/behavior/behavior_why.h"
#include "script/bindings/signal_expressions.h"
#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

using Texts = std::vector<std::string>;

const std::string regions = R"(
local k = require 'kadans'
return k.behavior 'greet' { initial = 'wait',
  k.state 'wait' { { after = 0.015, to = 'act' } },
  k.parallel 'act' {
    k.region 'arm' { initial = 'lift',
      k.state 'lift' { { after = 0.025, to = 'wave' } },
      k.state 'wave' { initial = 'left', k.state 'left' { endless = true } } },
    k.region 'gaze' { k.call 'look' },
    { after = 0.075, to = 'over' } },
  k.final 'over' {} }
)";
const std::string look = R"(
local k = require 'kadans'
return k.behavior 'look' { initial = 'near', k.state 'near' { { after = 0.035, to = 'far' } }, k.state 'far' { endless = true } }
)";

struct Greeting : Theatre {
  Greeting() {
    scripts.write("behaviors/lib/look.lua", look);
    scripts.write("behaviors/greet.lua", regions);
    ScriptHost::Settings settings;
    settings.play = list({"greet"});
    open(settings);
    host->declare_signals(signals);
  }
  double value(const std::string& name) const { return signals.read(signals.find("behavior.greet." + name).value()); }
  // A condition on the states, now.
  bool holds(const std::string& text) {
    SignalExpressions conditions(signals, host->signal_states());
    std::size_t index = 0;
    ExpressionError error;
    if (!conditions.add(text, index, error)) throw std::runtime_error(error.message);
    std::vector<double> row(signals.size());
    signals.gather(row);
    REQUIRE(conditions.evaluate(0, row));
    return conditions.holds(index);
  }
  SignalTable signals;
};

std::string refusal(const std::string& text, int& column) {
  const Greeting greeting;
  SignalExpressions conditions(greeting.signals, greeting.host->signal_states());
  std::size_t index = 0;
  ExpressionError error;
  CHECK_FALSE(conditions.add(text, index, error));
  column = error.column;
  return error.message;
}

const TransitionReason& to(const std::vector<TransitionReason>& reasons, const std::string& target) {
  for (const TransitionReason& reason : reasons) {
    if (reason.to == target) return reason;
  }
  throw std::runtime_error("no transition to " + target);
}

}  // namespace

TEST_CASE("all innermost active states are told by path when they change, and none when the behavior is over") {
  Greeting greeting;
  greeting.tick(20);
  CHECK(greeting.log.active == Texts{"greet: wait", "greet: act.arm.lift, act.gaze.look.near",
                                     "greet: act.arm.wave.left, act.gaze.look.near",
                                     "greet: act.arm.wave.left, act.gaze.look.far", "greet: "});
}

TEST_CASE("a behavior that an error ends has no active state") {
  Stage stage(
      "local k = require 'kadans'\nreturn k.behavior 'x' { k.state 'a' { during = function(m, s)\n"
      "  if m.time_s > 0.03 then error 'no' end end } }");
  stage.tick(2);
  CHECK(stage.behavior->active() == Texts{"a"});
  stage.play(10);
  CHECK(stage.behavior->failed());
  CHECK(stage.behavior->active().empty());
  CHECK(stage.log.active == Texts{"x: a", "x: "});
}

TEST_CASE("each region has a signal with the number of its innermost active state, 0 while it is not active") {
  Greeting greeting;
  greeting.tick();
  CHECK(greeting.value("region.act.arm") == 0);
  CHECK(greeting.value("region.act.gaze") == 0);
  greeting.tick(3);
  const auto& states = greeting.host->behavior(0).chart().states;
  const auto path = [&](const char* region) { return states[static_cast<std::size_t>(greeting.value(region))].path; };
  CHECK(path("region.act.arm") == "act.arm.lift");
  CHECK(path("region.act.gaze") == "act.gaze.look.near");
  greeting.tick(3);
  CHECK(path("region.act.arm") == "act.arm.wave.left");
  CHECK(path("region.act.gaze") == "act.gaze.look.far");
}

TEST_CASE("a condition knows each state by its path: outer ones, regions, states of a called behavior") {
  Greeting greeting;
  greeting.tick();
  CHECK(greeting.holds(
      "state('wait') and not state(\"act\") and not state('act.arm') and not state('act.gaze.look.near')"));
  greeting.tick(3);
  CHECK(greeting.holds("state('act') and state('act.arm') and state('act.arm.lift') and state('act.gaze.look.near')"));
  CHECK_FALSE(greeting.holds("state('wait') or state('act.gaze.look.far') or state('act.arm.wave')"));
  CHECK(greeting.holds("state( 'greet.act.arm' ) and state('greet.act.gaze.look.near')"));
  greeting.tick(3);
  CHECK(greeting.holds("state('act.arm.wave') and state('act.arm.wave.left') and state('act.gaze.look.far')"));
  greeting.tick(10);
  CHECK_FALSE(greeting.holds("state('act') or state('act.arm') or state('act.gaze.look.far') or state('over')"));
}

TEST_CASE("a condition's unknown state is refused with its column and what was meant") {
  int column = 0;
  CHECK(refusal("1 > 0 and state('act.arm.wav')", column) ==
        "no behavior has the state 'act.arm.wav', did you mean 'act.arm.wave'?");
  CHECK(column == 18);
  CHECK(refusal("state(act.arm)", column).starts_with("state wants the path of a state in quotes"));
  CHECK(refusal("state 'wait'", column).starts_with("state wants"));
  CHECK(refusal("state('wait'", column).starts_with("state wants"));
  CHECK(ExpressionError{.column = 12, .message = ""}.file_column("state(\"a\") and x") == 14);
}

TEST_CASE("after a reload the numbers are those of the first chart, and conditions hold as before") {
  Greeting greeting;
  greeting.tick(4);
  std::string changed = regions;
  changed.replace(changed.find("k.state 'wait'"), 0, "k.state 'more' { { after = 1, to = 'wait' } },\n  ");
  greeting.scripts.write("behaviors/greet.lua", changed);
  greeting.host->order({.kind = PlayOrder::Kind::reload, .behavior = {"greet", {}}});
  greeting.tick();
  REQUIRE(greeting.log.joined().find("reloaded") != std::string::npos);
  CHECK(greeting.holds("state('act.arm') and state('act.gaze.look.near') and not state('wait')"));
  CHECK(greeting.host->behavior(0).active() == Texts{"act.arm.lift", "act.gaze.look.near"});
}

TEST_CASE("why tells of each transition of the active states what has not come: event, time, guard with what it read") {
  Stage stage(R"(local k = require 'kadans'
return k.behavior 'x' { initial = 'in', vars = { n = 3 },
  k.state 'in' { initial = 'a', { on = 'go', to = 'off' },
    k.state 'a' { { after = 2, to = 'b' },
      { when = function(s, m)
          return s.base.pitch_rad > 0.5 and m.vars.n > 2
        end, to = 'c' },
      { when = function(s) return s.base.pitch_rad == 0.25 and s.base.nothing end, to = 'in.d' } },
    k.state 'b' { endless = true }, k.state 'c' { endless = true }, k.state 'd' { endless = true } },
  k.final 'off' {} }
)");
  stage.tick(51);
  stage.snapshot.status.base.pitch_rad = 0.25;
  const auto reasons = stage.behavior->why(stage.snapshot);
  REQUIRE(reasons.size() == 4);
  CHECK(to(reasons, "off").why == "no event 'go'");
  CHECK(to(reasons, "in.b").why == "1.49 s left of 2 s");
  const TransitionReason& guarded = to(reasons, "in.c");
  CHECK(guarded.why == "the guard gives false");
  CHECK(guarded.saw == "s.base.pitch_rad = 0.25, m.vars.n = 3");
  CHECK(guarded.guard.file == "behaviors/test.lua");
  CHECK(guarded.guard.line == 5);
  CHECK(guarded.guard.text ==
        "{ when = function(s, m)\n    return s.base.pitch_rad > 0.5 and m.vars.n > 2\n  end, to = 'c' },");
  CHECK(to(reasons, "in.d").why.find("the guard raises: ") == 0);
  CHECK(to(reasons, "in.d").why.find("nothing") != std::string::npos);
  stage.snapshot.status.base.pitch_rad = 0.75;
  CHECK(to(stage.behavior->why(stage.snapshot), "in.c").free);
  CHECK(stage.behavior->active() == Texts{"in.a"});
}

TEST_CASE(
    "why tells what a guard read behind a line that is cut for showing, and takes no names in texts and comments") {
  Stage stage(
      "local k = require 'kadans'\nreturn k.behavior 'x' { initial = 'a',\n"
      "k.state 'a' { { when = function(s)\n  if s.base == '" +
      std::string(200, 'x') +
      " s.base.roll_rad' then return false end -- s.base.yaw_rad\n  return s.base.pitch_rad > 0.5 end, to = 'b' } },\n"
      "k.state 'b' { endless = true } }");
  stage.tick(1);
  stage.snapshot.status.base.pitch_rad = 0.25;
  CHECK(to(stage.behavior->why(stage.snapshot), "b").saw == "s.base.pitch_rad = 0.25");
}

TEST_CASE("asking why changes nothing of the run, whatever the guards do") {
  const std::string text = R"(local k = require 'kadans'
return k.behavior 'x' { initial = 'a', vars = { n = 0 },
  k.state 'a' { during = function(m) print(m.vars.n, math.random()) end,
    { when = function(s, m)
        m.vars.n = m.vars.n + 1
        print('asked', math.random())
        return m.vars.n > 4
      end, to = 'b' } },
  k.state 'b' { endless = true, during = function() print(math.random()) end } }
)";
  const auto told = [&](bool asks) {
    Stage stage(text);
    for (int i = 0; i < 8; ++i) {
      stage.tick();
      if (asks) CHECK(stage.behavior->why(stage.snapshot).size() == (i < 5 ? 1 : 0));
    }
    CHECK_FALSE(stage.behavior->failed());
    CHECK(stage.behavior->state() == "b");
    return stage.said() + stage.log.transitions.front() + std::to_string(stage.applied.size());
  };
  CHECK(told(true) == told(false));
}

TEST_CASE("a guard that never ends costs its question the answer, not the run") {
  Stage stage(
      "local k = require 'kadans'\nreturn k.behavior 'x' { initial = 'a', k.state 'a' {\n"
      "  { when = function(s) while s.base.pitch_rad > 0.5 do end end, to = 'b' } }, k.state 'b' { endless = true } }");
  stage.tick(2);
  stage.snapshot.status.base.pitch_rad = 1;
  const auto reasons = stage.behavior->why(stage.snapshot);
  REQUIRE(reasons.size() == 1);
  CHECK(reasons[0].why.starts_with("the guard gives no answer within its budget"));
  stage.snapshot.status.base.pitch_rad = 0;
  CHECK(stage.tick(2));
  CHECK_FALSE(stage.behavior->failed());
}

TEST_CASE("why is refused while a behavior's file is another one than what plays") {
  Stage stage("local k = require 'kadans'\nreturn k.behavior 'x' { k.state 'a' { endless = true } }");
  stage.tick(2);
  stage.scripts.write("behaviors/test.lua",
                      "local k = require 'kadans'\nreturn k.behavior 'x' { k.state 'a' { endless = true } } --");
  CHECK_THROWS_WITH(stage.behavior->why(stage.snapshot), doctest::Contains("reload it first"));
}
