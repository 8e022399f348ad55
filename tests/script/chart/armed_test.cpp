// Transactions that a behavior arms: m:on. What the control engine does with them is tested in tests/engine.
#include <algorithm>

#include <doctest/doctest.h>

#include "kadans/signal/signal.h"
#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

double contact = 0, height_m = 0;

std::string armed_chart(const std::string& code, const std::string& out, const std::string& name = "a") {
  return "local k = require 'kadans'\nreturn k.behavior 'test' { controls = 'posture', initial = '" + name +
         "',\nk.state '" + name + "' { enter = function(m, s)\n" + code + "\nend,\n" + out +
         " }, k.state 'b' { endless = true } }\n";
}

constexpr const char* leads_to_b = "{ on = 'touched', to = 'b' },";
constexpr const char* arms_hold =
    "m:on('foot.right.contact', function(c) c.posture:hold() end, { within_s = 9, event = 'touched' })";

// A robot with two signals; `code` runs with m and s in `enter` of state "a". Event "touched" leads to "b".
struct ArmedStage : Stage {
  explicit ArmedStage(const std::string& code, const std::string& out = leads_to_b) : Stage(armed_chart(code, out)) {
    for (const char* foot : {"foot.l_sole.contact", "foot.l_sole.force_N", "foot.r_sole.contact"})
      robot.catalog.signals.add({foot, "", ""}, &contact);
    robot.catalog.signals.add({"base.height_m", "m", ""}, &height_m);
    robot.catalog.signals.add({"plant.base.height_m", "m", ""}, &height_m);
  }
  // What the control engine would have told.
  void tell(ArmedState state, std::uint32_t fired) {
    snapshot.armed[0] = {
        .sequence = sender.last_sequence(), .which = 0, .state = state, .fired = fired, .fired_tick = 77};
  }
  std::string error() const { return behavior->error().text(); }
};

std::string error_of(const std::string& code) {
  ArmedStage stage(code);
  stage.tick();
  return stage.error();
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("m:on sends the condition and what its function asks for, and nothing of it happens at once") {
  ArmedStage stage(
      "m:on('foot.right.contact', function(c) c:use('gesture') c.posture:set_parameter('l_knee.kp_Nm_per_rad', 55) "
      "end, "
      "{ within_s = 0.5 })\n"
      "m.posture:set('l_knee.position_rad', 1)");
  stage.tick();
  REQUIRE(stage.applied.size() == 1 + 1 + 1 + 2 + 1);
  const Command& arm = stage.applied[1];
  CHECK(stage.applied[0].count == 5);
  CHECK(arm.kind == CommandKind::arm);
  CHECK(arm.index == 1);
  CHECK(arm.count == 3);
  CHECK(arm.sequence == 0);
  CHECK(arm.duration_s == 0.5);
  CHECK(stage.applied[2].kind == CommandKind::condition);
  CHECK(stage.applied[2].time_ns == signal_key("foot.r_sole.contact"));
  CHECK(stage.applied[2].count == static_cast<std::uint32_t>(ConditionKind::above));
  CHECK(stage.applied[2].value == 0.5);
  CHECK(stage.applied[3].kind == CommandKind::switch_set);
  CHECK(stage.applied[3].index == 1);
  CHECK(stage.applied[4].value == 55);
  CHECK(stage.applied[5].kind == CommandKind::set_point);
}

TEST_CASE("what is armed may switch to another control set and command its objects") {
  ArmedStage stage(
      "m:on('foot.right.contact', function(c) c:use('gesture') c.arms:set('l_shoulder_pitch.position_rad', 1) end, "
      "{ within_s = 1 })\n"
      "print(pcall(function() return m.arms end))");
  stage.tick();
  CHECK(has(stage.said(), "false"));
  CHECK(stage.commands(CommandKind::switch_set) == 1);
  CHECK(stage.commands(CommandKind::set_point) == 1);
}

TEST_CASE("a condition is a signal, a time, the end of motions, or a few of them") {
  ArmedStage stage(
      "m:on({ any = { 'not foot.right.contact', 'base.height_m < 0.3', { after_s = 2 }, { arrived = m.posture } } },\n"
      "function(c) c.posture:hold() end, { within_s = 3, every_time = true })");
  stage.tick();
  CHECK(stage.error() == "");
  CHECK(stage.applied[1].index == 4);
  CHECK(stage.applied[1].sequence == (arm_any | arm_every_time));
  const auto kind = [&](std::size_t i) { return static_cast<ConditionKind>(stage.applied[i].count); };
  CHECK(kind(2) == ConditionKind::below);
  CHECK(stage.applied[2].value == 0.5);
  CHECK(kind(3) == ConditionKind::below);
  CHECK(stage.applied[3].value == 0.3);
  CHECK(stage.applied[3].time_ns == signal_key("base.height_m"));
  CHECK(kind(4) == ConditionKind::after);
  CHECK(stage.applied[4].value == 2);
  CHECK(kind(5) == ConditionKind::arrived);
  CHECK(stage.commands(CommandKind::cancel_motion) == 12);
}

TEST_CASE("when it acts, the behavior gets its event and the log a line, once each time") {
  ArmedStage stage("m:on('foot.right.contact', function(c) c.posture:hold() end, { within_s = 9, event = 'touched' })");
  stage.tick();
  stage.tell(ArmedState::waits, 0);
  stage.tick(3);
  CHECK(stage.behavior->state() == "a");
  stage.tell(ArmedState::done, 1);
  stage.tick(2);
  CHECK(stage.behavior->state() == "b");
  CHECK(stage.said() == "what a armed acted in tick 77\n");
  stage.tick(5);
  CHECK(stage.said() == "what a armed acted in tick 77\n");
}

TEST_CASE("the handle says what became of it, and takes it back") {
  ArmedStage stage(
      "m.vars.armed = m:on('foot.right.contact', function(c) c.posture:hold() end, { within_s = 9 })\n"
      "print(m.vars.armed.outcome, m.vars.armed.fired)",
      "{ when = function(s, m) return m.vars.armed.fired == 2 end, to = 'b', action = function(m)\n"
      "print(m.vars.armed.outcome) print(m.vars.armed:cancel()) end },");
  stage.tick();
  CHECK(stage.error() == "");
  stage.tell(ArmedState::waits, 2);
  stage.tick(2);
  CHECK(has(stage.said(), "waits 0\n"));
  CHECK(has(stage.said(), "waits\ntrue\n"));
}

TEST_CASE("what a state armed is taken back when the state is left") {
  ArmedStage stage("m:on('foot.right.contact', function(c) c.posture:hold() end, { within_s = 9 })",
                   "{ after = 0.05, to = 'b' },");
  stage.tick();
  const std::uint32_t number = stage.sender.last_sequence();
  stage.tell(ArmedState::waits, 0);
  stage.tick(10);
  REQUIRE(stage.commands(CommandKind::disarm) == 1);
  const auto disarm = std::ranges::find(stage.applied, CommandKind::disarm, &Command::kind);
  CHECK(disarm->sequence == number);
  CHECK(disarm->index == 0);
}

TEST_CASE("one that is refused, expired or gone is forgotten") {
  for (const ArmedState end : {ArmedState::refused, ArmedState::expired, ArmedState::none}) {
    ArmedStage stage("m:on('foot.right.contact', function(c) c.posture:hold() end, { within_s = 9 })",
                     "{ after = 0.05, to = 'b' },");
    stage.tick();
    stage.tell(end, 0);
    stage.tick(10);
    CHECK(stage.commands(CommandKind::disarm) == 0);
    CHECK(stage.behavior->transactions_refused() == (end == ArmedState::refused ? 1 : 0));
  }
}

TEST_CASE("a mistake in m:on is told with its line, and nothing is recorded any more") {
  const std::string what = ", function(c) c.posture:hold() end, { within_s = 1 })";
  CHECK(has(error_of("m:on('foot.right.contatc'" + what),
            "test.lua:4: m:on: unknown signal 'foot.r_sole.contatc', did you mean 'foot.r_sole.contact'"));
  CHECK(has(error_of("m:on('plant.base.height_m > 1'" + what), "is the truth of a simulation, which no robot knows"));
  CHECK(has(error_of("m:on('base.height_m > high'" + what), "behind < or > stands a number"));
  CHECK(has(error_of("m:on(7" + what), "this is no condition; a condition is \"foot.right.contact\""));
  CHECK(has(error_of("m:on({ all = {} }" + what), "there are too many conditions, or none"));
  CHECK(has(error_of("m:on({ after_s = -1 }" + what), "after_s is in 0..3600 s"));
  CHECK(has(error_of("m:on('base.height_m > 1', function(c) end, { within_s = 1 })"), "the function asks for nothing"));
  CHECK(has(error_of("m:on('base.height_m > 1', nil, { within_s = 1 })"), "needs a function that says what to do"));
  CHECK(has(error_of("m:on('base.height_m > 1', function(c) c.posture:hold() end)"), "{ within_s = seconds }"));
  CHECK(has(error_of("m:on('base.height_m > 1', function(c) c.posture:hold() end, { within_s = 0 })"), "0..3600 s"));
  CHECK(has(error_of("m:on('base.height_m > 1', function(c) c.posture:hold() end, { within = 1 })"), "m:on takes {"));
  CHECK(has(error_of("m:on('base.height_m > 1', function(c) c:emit('touched') end, { within_s = 1 })"),
            "event = \"name\""));
  CHECK(has(error_of("m:on('base.height_m > 1', function(c) c:clear_faults() end, { within_s = 1 })"),
            "cannot clear faults"));
  CHECK(has(error_of("m:on('base.height_m > 1', function(c) c:use('gestures') end, { within_s = 1 })"),
            "did you mean 'gesture'"));
  CHECK(
      has(error_of("m:on('base.height_m > 1', function(c) for i = 1, 7 do c.posture:hold() end end, { within_s = 1 })"),
          "more than 63 commands"));
  CHECK(has(error_of("m:use('gesture')"), "use() works inside the function of m:on"));
  ArmedStage stage(
      "pcall(m.on, m, 'base.height_m > 1', function(c) c.posture:hold() error('no') end, { within_s = 1 })\n"
      "m.posture:set('l_knee.position_rad', 1)");
  stage.tick();
  CHECK(stage.commands(CommandKind::set_point) == 1);
  CHECK(stage.commands(CommandKind::cancel_motion) == 0);
}

TEST_CASE(
    "one that is refused when its condition is true is told with the reason, and does not bring the state's sets "
    "back") {
  ArmedStage stage(
      "m:on('foot.right.contact', function(c) c:use('gesture') c.arms:set('l_shoulder_pitch.position_rad', 1) end, "
      "{ within_s = 9 })");
  stage.tick();
  const std::size_t sent = stage.applied.size();
  stage.snapshot.control_sets = 2;  // a person, or another reflex, switched to "gesture"
  stage.tell(ArmedState::refused, 0);
  stage.snapshot.refusals[0] = {.sequence = stage.sender.last_sequence(),
                                .kind = CommandKind::switch_set,
                                .reason = RefusalReason::set_dwells,
                                .joint = 0,
                                .index = 1,
                                .value = 0.125};
  stage.snapshot.transactions_refused = 1;
  stage.tick(5);
  CHECK(stage.applied.size() == sent);
  CHECK(stage.behavior->transactions_refused() == 1);
  CHECK(has(stage.said(),
            "what a armed was refused when its condition was true\nall its commands: control set gesture: "
            "posture cannot be switched for another 0.125 s (switch_dwell_s)\n"));
}

TEST_CASE("a reload leaves armed what belongs to a state that stays, with its event, and takes back the rest") {
  for (const bool stays : {true, false}) {
    CAPTURE(stays);
    ArmedStage stage(arms_hold);
    stage.tick();
    const std::uint32_t number = stage.sender.last_sequence();
    ArmedStatus& status = stage.snapshot.armed[0];
    status = {.sequence = number, .state = ArmedState::waits};
    stage.tick(2);
    stage.scripts.write("behaviors/test.lua", armed_chart("print 'new'", leads_to_b, stays ? "a" : "c"));
    REQUIRE(stage.behavior->reload(stage.snapshot, stage.sender) == Behavior::Reload::taken);
    stage.tick(3);
    CHECK((stage.commands(CommandKind::disarm) > 0) == !stays);
    status.state = ArmedState::done;
    status.fired = 1;
    stage.tick(3);
    CHECK(stage.behavior->state() == (stays ? "b" : "c"));
  }
}

TEST_CASE("in a pause it stays armed, and what happened meanwhile is told when the behavior goes on") {
  Theatre theatre;
  for (const char* foot : {"foot.l_sole.contact", "foot.l_sole.force_N", "foot.r_sole.contact"})
    theatre.robot.catalog.signals.add({foot, "", ""}, &contact);
  theatre.scripts.write("behaviors/main.lua", armed_chart(arms_hold, leads_to_b));
  ScriptHost::Settings settings;
  settings.play.push_back({.file = "behaviors/main.lua"});
  theatre.open(settings);
  theatre.tick();
  ArmedStatus& status = theatre.snapshot.armed[0];
  status = {.sequence = theatre.sender.last_sequence(), .state = ArmedState::waits};
  theatre.host->order({.kind = PlayOrder::Kind::pause});
  theatre.tick(5);
  REQUIRE(theatre.host->paused());
  CHECK(theatre.commands(CommandKind::disarm) == 0);
  status.state = ArmedState::done;
  status.fired = 1;
  theatre.tick(5);
  CHECK(theatre.host->behavior(0).state() == "a");
  theatre.host->order({.kind = PlayOrder::Kind::resume});
  theatre.tick(5);
  CHECK(theatre.host->behavior(0).state() == "b");
}
