// Errors of a chart's functions, refused transactions and faults as events.
#include <set>

#include <doctest/doctest.h>

#include "script/cast.h"

namespace recovery_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string head = R"(local k = require 'kadans'
local function log(text) return function() print(text) end end
local function tell(m, s) local d = s.event.data print(s.event.name, d.message, d.file, d.line, d.cause, d.state) end
)";

// A state with this body, and where its error leads to.
std::string failing(const std::string& body, const std::string& more = "") {
  return head + "return k.behavior 't' { controls = 'posture', vars = { n = 0 }, initial = 'a',\nk.state 'a' { " +
         body +
         ",\n{ on = 'error', to = 'safe', action = tell } }, k.state 'safe' { enter = log 'safe', endless = true }, "
         "k.state 'b' {}" +
         more + " }";
}

std::string played(const std::string& text, int ticks = 1) {
  Stage stage(text);
  stage.tick(ticks);
  return stage.behavior->failed() ? "failed: " + stage.behavior->error().text() : stage.said();
}

std::string told(const std::string& message, const std::string& cause, int line = 5, const std::string& state = "a") {
  const std::string at = std::to_string(line);
  return "error taken as an event: behaviors/test.lua:" + at + ": " + message + "\nerror " + message +
         " behaviors/test.lua " + at + " " + cause + " " + state + "\nsafe\n";
}

}  // namespace

TEST_CASE("an error of any function of a state is taken by its transition for error, in the same tick") {
  CHECK(played(failing("enter = function() error 'x' end")) == told("x", "enter"));
  CHECK(played(failing("during = function() error 'x' end")) == told("x", "during"));
  CHECK(played(failing("run = function() local none = nil; none() end")) ==
        told("attempt to call local 'none' (a nil value)", "run"));
  CHECK(played(failing("{ when = function() error 'x' end, to = 'b' }"), 2) == told("x", "when"));
  CHECK(played(failing("{ to = 'b', action = function() error 'x' end }"), 2).find("failed: ") == 0);  // 'a' is left
}

TEST_CASE("the innermost state around the function takes the error, an outer one when the inner guard says no") {
  const auto nested = [](const std::string& inner) {
    return head +
           "return k.behavior 't' { initial = 'a', k.state 'a' { k.state 'in' { initial = 'i', k.state 'i' {\n"
           "during = function() error 'x' end, exit = log 'out i' }, " +
           inner +
           " }, { on = 'error', to = 'far' } },\n"
           "k.state 'near' { enter = log 'near' }, k.state 'far' { enter = log 'far' } }";
  };
  const std::string first = "error taken as an event: behaviors/test.lua:5: x\nout i\n";
  CHECK(played(nested("{ on = 'error', to = 'near' }")) == first + "near\n");
  CHECK(played(nested("{ on = 'error', when = function() return false end, to = 'near' }")) == first + "far\n");
  CHECK(played(nested("endless = true")) == first + "far\n");
}

TEST_CASE("an error of one region is taken in it, and the other goes on") {
  Stage stage(
      head +
      "return k.behavior 't' { k.parallel 'p' {\n"
      "k.region 'l' { initial = 'a', k.state 'a' { during = function() error 'x' end, { on = 'error', to = 'b' } },\n"
      "k.state 'b' { enter = log 'b' } },\nk.region 'r' { k.state 'c' { during = log 'c' } },\n"
      "{ on = 'error', to = 'p', action = log 'all' } } }");
  stage.tick(2);
  CHECK(stage.said() == "c\nerror taken as an event: behaviors/test.lua:5: x\nb\nc\n");
}

TEST_CASE("an error of an exit or an action leads on from where the step led") {
  CHECK(played(head +
                   "return k.behavior 't' { initial = 'o', k.state 'o' { initial = 'a',\n"
                   "k.state 'a' { exit = function() error 'x' end, { to = 'b' } }, k.state 'b' { enter = log 'b' },\n"
                   "{ on = 'error', to = 'safe', action = tell } }, k.state 'safe' { enter = log 'safe' } }",
               2) == "b\n" + told("x", "exit", 5, "o.a"));
}

TEST_CASE("an error in a called behavior reaches the caller, unless the callee takes it") {
  for (const bool own : {false, true}) {
    Cast cast;
    cast.scripts.write(
        "behaviors/lib/called.lua",
        head +
            "return k.behavior 'called' { initial = 'x', k.state 'x' { enter = function() error 'x' end }, "
            "k.final 'y' { outcome = 'failed' }" +
            (own ? ", always = { { on = 'error', to = 'y' } }" : "") + " }");
    cast.write("main",
               "return k.behavior 'main' { initial = 'a', k.state 'a' { k.call 'called',\n"
               "{ on = 'error', to = 'b' }, { on = 'failed', to = 'c' } }, k.state 'b' { endless = true }, k.state "
               "'c' { endless = true } }");
    cast.play({"main"});
    cast.tick();
    CHECK(cast.host->behavior(0).state() == (own ? "c" : "b"));
  }
}

TEST_CASE(
    "of a function that raised what it asked for and emitted is dropped, what others asked for in the tick is sent") {
  Stage stage(head + R"(return k.behavior 't' { controls = 'posture', vars = { n = 0 }, initial = 'a',
    during = function(m) m.posture:set_parameter('l_knee.kp_Nm_per_rad', 50) end,
    k.state 'a' { during = function(m) m.vars.motion = m.posture:move('lean', { time_s = 1 }) m.vars.n = 7 m:emit 'go' error 'x' end,
      { on = 'go', to = 'b' }, { on = 'error', to = 'b' } },
    k.state 'b' { enter = function(m) m.posture:set_parameter('r_knee.kp_Nm_per_rad', m.vars.n) print(m.vars.motion.outcome) end,
      { on = 'go', to = 'c' } }, k.state 'c' { enter = log 'c' } })");
  stage.tick(3);
  CHECK(stage.commands(CommandKind::set_point) == 0);
  CHECK(stage.commands(CommandKind::set_parameter) == 1 + 1 + 2);
  CHECK(stage.applied[1].value == 50);
  CHECK(stage.applied[2].value == 7);
  CHECK(stage.said() == "error taken as an event: behaviors/test.lua:6: x\ncancelled\n");
}

TEST_CASE("a second error in the same tick ends the behavior, one in the next tick does not") {
  const auto again = [](const std::string& enter) {
    return played(head +
                      "return k.behavior 't' { initial = 'a', k.state 'a' { enter = function() error 'one' end, { on = "
                      "'error', to = 'b' } },\nk.state 'b' { " +
                      enter +
                      ", { on = 'error', to = 'c' } }, k.state 'c' { enter = "
                      "log 'c' } }",
                  2);
  };
  CHECK(again("enter = function() error 'two' end") == "failed: behaviors/test.lua:5: two");
  CHECK(again("during = function(m) if m.time_s > 0 then error 'two' end end").find("\nc\n") != std::string::npos);
}

TEST_CASE("an error that nobody takes ends the behavior as ever, its states left") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', k.state 'a' { exit = log 'left', during = function() error 'x' "
              "end, { on = 'error', when = function() return false end, to = 'b' } }, k.state 'b' {} }");
  stage.tick();
  CHECK(stage.behavior->error().text() == "behaviors/test.lua:4: x");
  CHECK(stage.said() == "left\n");
}

TEST_CASE("a breach of the budget is no error to recover from") {
  Stage stage(failing("enter = function() while true do end end"));
  stage.tick();
  CHECK(stage.behavior->error().breach == ScriptBreach::instructions);
  CHECK(stage.said() == "");
}

TEST_CASE("the state whose enter raised is active, and nothing in it is entered or run") {
  CHECK(
      played(head +
             "return k.behavior 't' { initial = 'a', k.state 'a' { enter = function() error 'x' end,\n"
             "run = log 'run', exit = log 'out', k.state 'in' { enter = log 'in' }, { on = 'error', to = 'safe' } },\n"
             "k.state 'safe' { enter = log 'safe' } }") ==
      "error taken as an event: behaviors/test.lua:4: x\nout\nsafe\n");
}

TEST_CASE("a refused transaction is an event for who waits for it, with the reason and what") {
  const std::string text =
      head +
      "return k.behavior 't' { controls = 'posture', initial = 'a', k.state 'a' {\n"
      "enter = function(m) m.posture:set_parameter('l_knee.kp_Nm_per_rad', 50) end,\n"
      "{ on = 'refused', to = 'b', action = function(m, s) print(s.event.data.reason, s.event.data.what) end } },\n"
      "k.state 'b' { endless = true } }";
  Stage stage(text);
  stage.tick();
  const auto refuse = [&] {
    Refusal& refusal = stage.snapshot.refusals[stage.snapshot.transactions_refused++ % refusals_shown];
    refusal = {.sequence = stage.sender.last_sequence(),
               .kind = CommandKind::set_parameter,
               .reason = RefusalReason::robot_held};
  };
  refuse();
  stage.tick();
  CHECK(stage.behavior->state() == "b");
  CHECK(stage.log.messages.back() == "t: robot_held posture.l_hip_yaw.kp_Nm_per_rad: the robot is held");
  refuse();
  stage.tick();
  CHECK(stage.behavior->events_unhandled() == 0);  // nobody waits for it any more
}

TEST_CASE("each reason of a refusal has a word of its own, which s.event.data.reason shows") {
  const std::string text =
      head +
      "return k.behavior 't' { controls = 'posture', initial = 'a', k.state 'a' { endless = true,\n"
      "{ on = 'refused', action = function(m, s) print(s.event.data.reason) end } } }";
  Stage stage(text);
  stage.tick();
  std::set<std::string> words;
  for (int reason = 1; reason <= static_cast<int>(RefusalReason::set_dwells); ++reason) {
    Refusal& refusal = stage.snapshot.refusals[stage.snapshot.transactions_refused++ % refusals_shown];
    refusal = {.sequence = stage.sender.last_sequence(),
               .kind = CommandKind::switch_set,
               .reason = static_cast<RefusalReason>(reason),
               .joint = 0};
    stage.tick();
    words.insert(stage.log.messages.back());
  }
  CHECK(words.size() == static_cast<std::size_t>(RefusalReason::set_dwells));
  CHECK(words.contains("t: set_dwells"));
}

TEST_CASE("a tick whose commands found no place is told as refused in the next one") {
  Stage stage(head + R"(return k.behavior 't' { controls = 'posture', initial = 'a', k.state 'a' {
    during = function(m) m.posture:set_gains('stiff') end,
    { on = 'refused', to = 'b', action = function(m, s) print(s.event.data.reason) end } }, k.state 'b' { endless = true } })");
  stage.applying = false;
  stage.tick(1000);
  CHECK(stage.said() == "queue_full: the commands of this tick were refused, all of them\nqueue_full\n");
  CHECK(stage.behavior->state() == "b");
}

TEST_CASE("a fault is an event when it is noted, once, and not one from before the start") {
  Stage stage(head +
              "return k.behavior 't' { initial = 'a', k.state 'a' {\n"
              "{ on = 'fault.motor_hot', to = 'a', action = function(m, s) local d = s.event.data\n"
              "print(d.joint, d.value, d.limit) end }, { on = 'fault.tilt', to = 'a', action = log 'tilt' } } }");
  const auto fault = [&](FaultCode code, std::uint16_t joint) {
    SafetyStatus& safety = stage.snapshot.status.safety;
    safety.new_faults[safety.faults_raised++ % new_faults_shown] = {code, joint, 121, 120};
  };
  fault(FaultCode::tilt, no_joint);
  stage.tick(2);
  CHECK(stage.said() == "");
  fault(FaultCode::motor_hot, 3);
  fault(FaultCode::motor_warm, 3);
  fault(FaultCode::motor_hot, no_joint);
  stage.tick(2);
  CHECK(stage.said() == "l_knee 121 120\nnil 121 120\n");
  CHECK(stage.behavior->events_unhandled() == 0);
}

TEST_CASE("a fault that no active state waits for is no event, not even for the state that is entered in its tick") {
  Stage stage(
      head +
      R"(return k.behavior 't' { initial = 'a', k.state 'a' { { when = function(s) return s.safety.faults > 0 end, to = 'b' } },
    k.state 'b' { { on = 'fault.tilt', to = 'c' } }, k.state 'c' {} })");
  stage.tick(2);
  SafetyStatus& safety = stage.snapshot.status.safety;
  safety.new_faults[safety.faults_raised++] = {FaultCode::tilt, no_joint, 2, 1};
  safety.fault_count = 1;
  stage.tick(2);
  CHECK(stage.behavior->state() == "b");
}

TEST_CASE("reports cannot be emitted, and faults that do not exist and outcomes of their names are refused") {
  CHECK(played(failing("enter = function(m) m:emit 'error' end")) ==
        told("'error' reports what happened to the behavior, it cannot be emitted: give the event another name",
             "enter"));
  Stage stage(failing("endless = true"));
  stage.tick();
  CHECK_FALSE(stage.behavior->post("error"));
  CHECK(load_error(head +
                   "return k.behavior 't' { initial = 'a', k.state 'a' {\n{ on = 'fault.motor_hto', to = 'a' } } }") ==
        "behaviors/test.lua:5: the safety layer knows no 'fault.motor_hto', did you mean 'fault.motor_hot'?");
  CHECK(load_error(head + "return k.behavior 't' {\nk.final 'a' { outcome = 'error' } }")
            .find("behaviors/test.lua:5: final 'a' cannot end with 'error'") == 0);
}

TEST_CASE("a guard's error is taken before the events that wait behind the one it was asked for") {
  const std::string said =
      played(failing("enter = function(m) m:emit 'one' m:emit 'two' end,\n"
                     "{ on = 'one', when = function() error 'x' end, to = 'b' }, { on = 'two', to = 'b' }"),
             2);
  CHECK(said.find(told("x", "when", 6)) == 0);  // and neither event led to 'b'
}

TEST_CASE("an error in the step that ends a behavior is taken, and the behavior goes on") {
  Stage stage(
      head +
      "return k.behavior 't' { controls = 'posture', initial = 'a', always = { { on = 'error', to = 'safe' } },\n"
      "k.state 'a' { exit = function() error 'x' end, { after = 0.02, to = 'over' } },\n"
      "k.state 'safe' { enter = log 'safe', endless = true }, k.final 'over' {} }");
  stage.tick(6);
  CHECK_FALSE(stage.behavior->failed());
  CHECK(stage.behavior->state() == "safe");
}

TEST_CASE("a motion whose cancel was taken back with its function goes on, and says so") {
  Stage stage(head + R"(return k.behavior 't' { controls = 'posture', vars = {}, initial = 'a',
    k.state 'a' { enter = function(m) m.vars.motion = m.posture:move('lean', { time_s = 1 }) end,
      during = function(m) if m.time_s > 0.025 then m.vars.motion:cancel() error 'x' end end,
      { on = 'error', to = 'b' } },
    k.state 'b' { enter = function(m) print(m.vars.motion.outcome, m.vars.motion.done) end,
      { after = 1.2, to = 'c' } },
    k.state 'c' { enter = function(m) print(m.vars.motion.outcome, m.vars.motion.done) end } })");
  stage.tick(140);
  CHECK(stage.commands(CommandKind::cancel_motion) == 0);
  CHECK(stage.said() == "error taken as an event: behaviors/test.lua:6: x\nmoving false\ndone true\n");
}

TEST_CASE("a motion whose cancel the control engine refused goes on, and says so") {
  Cast cast;
  cast.write("main", R"(return k.behavior 'main' { controls = 'posture', vars = {}, k.state 'a' { endless = true,
    enter = function(m) m.vars.motion = m.posture:move('lean', { time_s = 1 }) end,
    during = function(m)
      if m.vars.cancelled then print(m.vars.motion.outcome) end
      if m.time_s > 0.025 and not m.vars.cancelled then m.vars.cancelled = m.vars.motion:cancel() end
    end } })");
  cast.play({"main"});
  cast.tick(3);
  cast.refuse_tick(RefusalReason::robot_held);
  cast.tick(2);
  CHECK(cast.commands(CommandKind::cancel_motion) == 0);
  CHECK(cast.log.joined() ==
        "refused by the control engine, all commands of that tick: the robot is held\nmoving\nmoving\n");
}

TEST_CASE("nobody changes the data of an event for others: a function has a copy of its own") {
  Stage stage(head + R"(local function spoil(d) d.n = d.n + 1 d.list[1] = 'spoilt' d.more = true return false end
    return k.behavior 't' { vars = {}, initial = 'a', k.parallel 'a' {
      k.region 'l' { initial = 'x', k.state 'x' { { on = 'go', when = function(s) return spoil(s.event.data) end, to = 'y' },
        { on = 'go', action = function(m, s) spoil(s.event.data) m.vars.kept = s.event.data m.vars.kept.n = 9 end, to = 'y' } },
        k.state 'y' { enter = function(m, s) print(s.event.data.n, #s.event.data.list, s.event.data.list[1], s.event.data.more) end } },
      k.region 'r' { initial = 'x', k.state 'x' { { on = 'go', to = 'y', action = function(m, s)
        local d = s.event.data
        for i, v in ipairs(d.list) do print(i, v) end
        print(d.n, d == s.event.data, m.vars.kept.n) end } }, k.state 'y' {} },
      { after = 0.02, to = 'a', action = function(m) print(m.vars.kept.n, m.vars.kept.list[1]) end } },
      enter = function(m) m:emit('go', { n = 1, list = { 'p', 'q' } }) end })");
  stage.tick(4);
  CHECK(stage.behavior->error().text() == "");
  CHECK(stage.said() == "1 p\n2 q\n1 true 9\n1 2 p nil\n9 spoilt\n");
}

TEST_CASE("nobody changes the result of a behavior that has ended by what its event brings") {
  Cast cast;
  cast.scripts.write(
      "behaviors/lib/called.lua",
      "local k = require 'kadans'\nreturn k.behavior 'called' { k.final 'x' { outcome = 'done', result = "
      "function() return { n = 1 } end } }");
  cast.write("main",
             "local function spoil(r) r.n = 7 return false end\n"
             "return k.behavior 'main' { initial = 'a', k.state 'a' { k.call 'called',\n"
             "{ on = 'done', when = function(s) return spoil(s.event.data.result) end, to = 'b' },\n"
             "{ on = 'done', to = 'b', action = function(m, s) print(s.event.data.result.n) end } }, k.state 'b' {} }");
  cast.play({"main"});
  cast.tick(2);
  CHECK(cast.log.joined() == "1\n");
}

}  // namespace recovery_test
