// Control sets that states name: switched to with the transition, inherited, taken back.
#include <algorithm>

#include <doctest/doctest.h>

#include "script/cast.h"
#include "script/check/check_behavior.h"

namespace state_sets_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

using Kinds = std::vector<CommandKind>;
using Switches = std::vector<std::uint32_t>;

// The kinds of the commands in the last transaction that was applied, each once in a row.
Kinds last_transaction(const Cast& cast) {
  Kinds kinds;
  for (const Command& command : cast.applied) {
    if (command.kind == CommandKind::transaction) kinds.clear();
    if (command.kind != CommandKind::transaction && (kinds.empty() || kinds.back() != command.kind))
      kinds.push_back(command.kind);
  }
  return kinds;
}

void play_alone(Cast& cast, const std::string& text) {
  cast.write("main", text);
  cast.play({"main"});
}

std::string ends_after(const std::string& time_s) { return "{ after = " + time_s + ", to = 'z' }"; }

}  // namespace

TEST_CASE("a state's control set is switched to with the transition: after the exits, before what its enter commands") {
  Cast cast;
  play_alone(cast,
             "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' {\n"
             "exit = function(m) m.posture:set_parameter('l_knee.kp_Nm_per_rad', 50) end, { after = 0.02, to = 'b',\n"
             "action = function(m) m:clear_faults() end } },\n"
             "k.state 'b' { controls = 'gesture', enter = function(m) m.arms:move('lean', { time_s = 0.1 }) end,\n"
             "{ after = 0.03, to = 'c' } }, k.state 'c' { endless = true } }");
  cast.tick();
  CHECK(cast.switches().empty());  // active from the start
  cast.tick(2);
  CHECK(last_transaction(cast) ==
        Kinds{CommandKind::set_parameter, CommandKind::clear_faults, CommandKind::switch_set, CommandKind::set_point});
  CHECK(cast.snapshot.control_sets == set_bit(gesture));
  CHECK(cast.host->behavior(0).state() == "b");
  cast.tick(3);
  CHECK(cast.host->behavior(0).state() == "c");  // and is taken back with the next one
  CHECK(last_transaction(cast) == Kinds{CommandKind::switch_set});
  CHECK(cast.snapshot.control_sets == set_bit(posture));
  cast.tick(5);
  CHECK(cast.switches() == Switches{gesture, posture});
  CHECK(cast.log.errors == 0);
}

TEST_CASE("children inherit the control set of the state around them, or run on their own") {
  Cast cast;
  play_alone(cast,
             "return k.behavior 'main' { controls = 'posture', initial = 'out', k.state 'out' { controls = 'legs',\n"
             "initial = 'one', k.state 'one' { { after = 0.02, to = 'two' },\n"
             "enter = function(m) m.legs:move('lean', { time_s = 0.1 }) end },\n"
             "k.state 'two' { controls = 'posture', { after = 0.02, to = 'three' } },\n"
             "k.state 'three' { initial = 'deep', k.state 'deep' { " +
                 ends_after("0.02") + " } } }, k.final 'z' {} }");
  cast.tick();
  CHECK(cast.snapshot.control_sets == set_bit(legs));
  cast.tick(2);
  CHECK(cast.host->behavior(0).state() == "out.two");
  CHECK(cast.snapshot.control_sets == set_bit(posture));
  cast.tick(2);
  CHECK(cast.host->behavior(0).state() == "out.three.deep");
  CHECK(cast.snapshot.control_sets == set_bit(legs));
  cast.tick(2);
  CHECK(cast.host->behavior(0).outcome() == "done");
  CHECK(cast.snapshot.control_sets == set_bit(posture));  // which the final state inherits
  CHECK(cast.switches() == Switches{legs, posture, legs, posture});
  CHECK(cast.log.errors == 0);
}

TEST_CASE("a state may name several sets, and the regions of a parallel one each") {
  Cast cast;
  play_alone(cast,
             "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' { { after = 0.02, to = 'p' } "
             "},\nk.parallel 'p' { k.region 'l' { controls = 'legs', k.state 'x' { endless = true,\n"
             "enter = function(m) m.legs:set_gains('soft') end } }, k.region 'r' { controls = 'gesture',\n"
             "k.state 'y' { endless = true, enter = function(m) m.arms:set_gains('soft') end } },\n"
             "{ after = 0.03, to = 'both' } }, k.state 'both' { controls = { 'gesture', 'legs' }, endless = true,\n"
             "enter = function(m) m.legs:set_gains('stiff') m.arms:set_gains('stiff') end,\n"
             "{ after = 0.02, to = 'a' } } }");
  cast.tick(3);
  CHECK(cast.snapshot.control_sets == (set_bit(legs) | set_bit(gesture)));
  CHECK(last_transaction(cast) == Kinds{CommandKind::switch_set, CommandKind::set_parameter});
  cast.tick(3);
  CHECK(cast.host->behavior(0).state() == "both");
  CHECK(cast.switches() == Switches{gesture, legs});  // active already
  cast.tick(2);
  CHECK(cast.host->behavior(0).state() == "a");
  CHECK(cast.switches() == Switches{gesture, legs, posture});
  CHECK(cast.log.errors == 0);
}

TEST_CASE("a called behavior may take joints of its caller and gives them back when it is left") {
  Cast cast;
  cast.write("lib/nods",
             "return k.behavior 'nods' { controls = 'gesture', k.state 'n' { endless = true, enter = function(m)\n"
             "m.arms:move('lean', { time_s = 0.1 }) end, exit = function(m) m.arms:set_gains('soft') end } }");
  play_alone(cast,
             "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' { k.call 'nods',\n"
             "{ after = 0.03, to = 'b' } }, k.state 'b' { endless = true,\n"
             "enter = function(m) m.posture:move('stand', { time_s = 0.1 }) end } }");
  cast.tick();
  CHECK(cast.snapshot.control_sets == set_bit(gesture));
  cast.tick(3);
  CHECK(last_transaction(cast) == Kinds{CommandKind::set_parameter, CommandKind::switch_set, CommandKind::set_point});
  CHECK(cast.snapshot.control_sets == set_bit(posture));
  CHECK(cast.switches() == Switches{gesture, posture});
  CHECK(cast.log.errors == 0);
}

TEST_CASE("regions that could be active together on sets with a common joint are refused where the later is named") {
  Cast cast;
  const auto regions = [&](const std::string& top, const std::string& one, const std::string& other) {
    cast.write("main", "return k.behavior 'main' { " + top + "initial = 'p', k.parallel 'p' { k.region 'l' {" + one +
                           "\nk.state 'x' { endless = true } },\nk.region 'r' { initial = 'y', k.state 'y' {\n" +
                           other + "endless = true }, k.state 'q' { endless = true } } } }");
    return cast.refusal({"main"});
  };
  const std::string why = "; the regions of a parallel run on the same control sets, or on sets without a common joint";
  const std::string joint = " both drive joint 'l_shoulder_pitch'";
  CHECK(
      regions("", "controls = 'gesture',", "controls = 'posture', ") ==
      "behaviors/main.lua:5: state 'p.r.y' cannot be active beside state 'p.l': control sets 'gesture' and 'posture'" +
          joint + why);
  CHECK(
      regions("controls = 'posture', ", "", "controls = 'gesture', ") ==
      "behaviors/main.lua:5: state 'p.r.y' cannot be active beside state 'p.l': control sets 'posture' and 'gesture'" +
          joint + why);
  CHECK(regions("controls = 'posture', ", "controls = 'gesture',", "") ==
        "behaviors/main.lua:2: state 'p.l' cannot be active beside state 'p.r': control sets 'posture' and 'gesture'" +
            joint + why);
  CHECK(regions("controls = 'gesture', ", "controls = 'legs',", "controls = { 'legs' }, ").empty());
  CHECK(regions("", "controls = { 'legs', 'posture' },", "") ==
        "behaviors/main.lua:2: 'controls' names sets that exclude each other: control sets 'posture' and 'legs' both "
        "drive joint 'l_hip_yaw'");
  CHECK(regions("", "controls = 'leg',", "") ==
        "behaviors/main.lua:2: unknown control set 'leg' in 'controls', did you mean 'legs'?");
  CHECK(regions("", "controls = {},", "") ==
        "behaviors/main.lua:2: 'controls' is a list of 1..32 names of control sets, not of 0: controls = { \"legs\", "
        "\"arms\" }");
  CHECK(regions("", "controls = { 1 },", "") ==
        "behaviors/main.lua:2: 'controls' lists names of control sets, not a number");
  CHECK(regions("", "controls = true,", "") ==
        "behaviors/main.lua:2: 'controls' must be the name of a control set or a list of names, not a boolean");
}

TEST_CASE("lanes compare all sets that their behaviors may ever run on") {
  Cast cast;
  cast.write("a",
             "return k.behavior 'a' { controls = 'legs', initial = 'x', k.state 'x' { { after = 1, to = 'y' } },\n"
             "k.state 'y' { controls = 'posture', endless = true } }");
  cast.write("nods", "return k.behavior 'nods' { controls = 'gesture', k.state 'x' { endless = true } }");
  CHECK(cast.refusal({"a", "nods"}) ==
        "behaviors that play at the same time: control sets 'posture' and 'gesture' both drive joint "
        "'l_shoulder_pitch'");
}

TEST_CASE("an object that the sets of a state do not hold is an error where one of its functions uses it") {
  Cast cast;
  const std::string text =
      "local function softly(m) m.arms:set_gains('soft') end\n"
      "return k.behavior 'main' { controls = 'legs', initial = 'a', k.state 'a' { initial = 'i',\n"
      "k.state 'i' { run = function(m) m:wait(0.015)\nsoftly(m) end, { after = 0.1, to = 'b' } } },\n"
      "k.state 'b' { controls = 'gesture', endless = true, enter = softly } }";
  const auto check = [&] {
    return check_behavior(cast.scripts.root, cast.scripts.root / "behaviors/main.lua", cast.robot.catalog);
  };
  play_alone(cast, text);
  CHECK(check().empty());  // one of the two states holds it
  cast.tick(5);
  CHECK(cast.host->behavior(0).error().text() ==
        "behaviors/main.lua:2: 'arms' is not in the control sets of state 'a.i' ('legs'): give the state controls = "
        "\"gesture\"");
  cast.write("lib/nods",
             "return k.behavior 'nods' { k.state 'n' { endless = true, enter = function(m)\n"
             "m.posture:set_gains('soft') end } }");
  play_alone(cast, "return k.behavior 'main' { controls = { 'legs', 'gesture' }, k.state 'a' { k.call 'nods' } }");
  cast.tick(2);
  CHECK(cast.host->behavior(0).error().text() ==
        "behaviors/lib/nods.lua:3: control object 'posture' is not in this behavior's control sets, 'gesture' and "
        "'legs'");
}

TEST_CASE("the check finds objects that the sets of a state do not hold in the functions of that state") {
  Cast cast;
  cast.write(
      "main",
      "return k.behavior 'main' { controls = 'legs', initial = 'a', k.state 'a' { controls = 'gesture',\n"
      "enter = function(m)\nif m.name == 'x' then m.legs:set_gains('soft') end\nend,\n"
      "{ after = 1, to = 'b', action = function(m)\nm.arms:set_gains('soft')\nm.legs:set_gains('soft')\nend } },\n"
      "k.state 'b' { endless = true, enter = function(m)\nm.legs:set_gains('soft')\nend } }");
  const auto found = check_behavior(cast.scripts.root, cast.scripts.root / "behaviors/main.lua", cast.robot.catalog);
  REQUIRE(found.size() == 2);
  CHECK(found[0].line == 4);
  CHECK(found[1].line == 8);
  for (const InputProblem& one : found) {
    CHECK(one.file == "behaviors/main.lua");
    CHECK(one.message ==
          "'legs' is not in the control sets of state 'a' ('gesture'): give the state controls = \"legs\"");
  }
}

TEST_CASE("the check follows a state's functions into those that they call, and into a line with several") {
  Cast cast;
  const auto problems = [&](const std::string& enter) {
    cast.write("main",
               "local function soft(m)\nm.legs:set_gains('soft') end\n"
               "return k.behavior 'main' { controls = 'legs', initial = 'a', k.state 'a' { controls = 'gesture',\n"
               "exit = function() end, enter = function(m) " +
                   enter +
                   " end,\n{ after = 1, to = 'b' } }, k.state 'b' { endless = true,\n"
                   "enter = function(m) m.legs:set_gains('soft') end } }");
    return check_behavior(cast.scripts.root, cast.scripts.root / "behaviors/main.lua", cast.robot.catalog);
  };
  CHECK(problems("soft({ legs = m.arms })").empty());
  const std::string message =
      "'legs' is not in the control sets of state 'a' ('gesture'): give the state controls = \"legs\"";
  auto found = problems("soft(m)");
  REQUIRE(found.size() == 1);
  CHECK(found[0].line == 3);
  CHECK(found[0].message == message);
  found = problems("m.legs:set_gains('soft')");
  REQUIRE(found.size() == 1);
  CHECK(found[0].line == 5);
  CHECK(found[0].message == message);
}

TEST_CASE("a reload keeps to the set of the state that is active, and switches when the new version names another") {
  Cast cast;
  const auto version = [&](const std::string& set, const std::string& more) {
    cast.write("main", "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' { controls = '" +
                           set + "', endless = true, " + more +
                           " { after = 0.2, to = 'b' } }, k.state 'b' {\n"
                           "endless = true } }");
  };
  const auto reload = [&] {
    cast.host->order({.kind = PlayOrder::Kind::reload, .behavior = {"main", {}}, .file = {}});
    cast.tick(2);
  };
  version("gesture", "");
  cast.play({"main"});
  cast.tick(3);
  version("gesture", "during = function() end,");
  reload();
  CHECK(cast.switches() == Switches{gesture});
  version("legs", "");
  reload();
  CHECK(cast.switches() == Switches{gesture, legs});
  cast.tick(20);
  CHECK(cast.host->behavior(0).state() == "b");
  CHECK(cast.switches() == Switches{gesture, legs, posture});
}

TEST_CASE("a version that is taken back leaves the sets as the old one needs them") {
  Cast cast;
  const auto version = [&](const std::string& set, const std::string& more) {
    cast.write("main",
               "return k.behavior 'main' { controls = '" + set + "', k.state 'a' { endless = true, " + more + "} }");
  };
  version("legs", "");
  cast.play({"main"});
  cast.tick(3);
  version("gesture", "during = function() end,");
  cast.host->order({.kind = PlayOrder::Kind::reload, .behavior = {"main", {}}, .file = {}});
  cast.tick(2);
  version("posture", "{ after = 0.06, to = 'a', action = function() error('bad') end }");
  cast.host->order({.kind = PlayOrder::Kind::reload, .behavior = {"main", {}}, .file = {}});
  cast.tick(8);
  CHECK(cast.switches() == Switches{legs, gesture, posture, gesture});
}

TEST_CASE("sets of a transaction that was refused are asked for again as soon as the robot is not held") {
  Cast cast;
  play_alone(cast,
             "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' { { after = 0.02, to = 'b' } "
             "}, k.state 'b' { controls = 'legs', endless = true } }");
  cast.tick(2);
  cast.refuse_tick(RefusalReason::robot_held);
  cast.snapshot.status.safety.level = SafetyLevel::hold;
  cast.tick(3);
  CHECK(cast.switches().empty());
  cast.snapshot.status.safety.level = SafetyLevel::normal;
  cast.tick();
  CHECK(cast.switches() == Switches{legs});
  cast.tick(5);
  CHECK(cast.switches() == Switches{legs});
}

TEST_CASE("a transition that cannot be sent, and the next that wants other sets: only the newest are switched to") {
  Cast cast;
  play_alone(cast,
             "return k.behavior 'main' { controls = 'posture', initial = 'a', k.state 'a' { { after = 0.02, to = 'b' } "
             "}, k.state 'b' { controls = 'legs', { after = 0.01, to = 'c' } },\n"
             "k.state 'c' { controls = 'gesture', endless = true } }");
  cast.tick(2);
  cast.applying = false;
  while (cast.queue.free() > 1) {
    cast.sender.begin(0);
    const std::size_t places = std::min<std::size_t>(cast.queue.free(), 200);
    for (std::size_t i = 1; i < places; ++i) REQUIRE(cast.sender.add({.kind = CommandKind::clear_faults}));
    REQUIRE(cast.sender.commit() != 0);
  }
  cast.tick(2);  // b, then c: neither finds a place
  CHECK(cast.host->behavior(0).state() == "c");
  cast.applying = true;
  cast.step();
  cast.tick(3);
  CHECK(cast.switches() == Switches{gesture});
}

TEST_CASE("a behavior of a list does not rely on sets that the one before it is about to leave") {
  Cast cast;
  cast.write("a",
             "return k.behavior 'a' { controls = 'posture', initial = 'x', k.state 'x' { controls = 'gesture',\n"
             "{ after = 0.03, to = 'z' } }, k.final 'z' {} }");
  cast.write("b", "return k.behavior 'b' { controls = 'gesture', k.state 'x' { endless = true } }");
  ScriptHost::Settings settings;
  settings.play = cast.list({"a", "b"});
  cast.open(settings);
  cast.tick(3);
  cast.applying = false;
  cast.tick(2);  // a's last one, b's first one
  cast.applying = true;
  cast.tick();
  CHECK(cast.host->behavior(0).name() == "a");
  CHECK(cast.switches() == Switches{gesture, posture, gesture});
}

TEST_CASE("a transition leaves the sets of other regions as a reflex or a person has switched them") {
  Cast cast;
  play_alone(cast,
             "return k.behavior 'main' { k.parallel 'p' { k.region 'l' { controls = 'legs', initial = 'a',\n"
             "k.state 'a' { { after = 0.1, to = 'b' } }, k.state 'b' { endless = true } },\n"
             "k.region 'r' { controls = 'gesture', initial = 'a', k.state 'a' { { after = 0.04, to = 'b' } },\n"
             "k.state 'b' { endless = true } } } }");
  cast.tick(2);
  CHECK(cast.switches() == Switches{gesture, legs});
  cast.snapshot.control_sets = set_bit(gesture);  // something else has the legs
  cast.tick(4);
  CHECK(cast.log.transitions.size() == 1);  // r.b was entered
  CHECK(cast.switches() == Switches{gesture, legs});
  cast.tick(6);  // a state that is entered takes them back
  CHECK(cast.log.transitions.size() == 2);
  CHECK(cast.switches() == Switches{gesture, legs, legs});
}

}  // namespace state_sets_test
