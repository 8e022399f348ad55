// Control sets of behaviors that are called or played beside others.
#include <doctest/doctest.h>

#include "script/cast.h"
#include "script/check/check_behavior.h"

namespace machine_sets_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

const std::string nods =
    "return k.behavior 'nods' { controls = 'gesture', initial = 'a', k.state 'a' { "
    "run = function(m) m.arms:move('lean', { time_s = 0.05 }):wait() end, "
    "{ on = 'run.done', to = 'b' } }, k.final 'b' { outcome = 'done' } }";

std::string caller(const std::string& inside) {
  return "return k.behavior 'caller' { controls = 'legs', initial = 'a', k.state 'a' { { after = 0.02, to = 'c' } },\n"
         "k.state 'c' { " +
         inside + ", { on = 'done', to = 'z' } }, k.final 'z' { outcome = 'done' } }";
}

}  // namespace

TEST_CASE("a called behavior with joints of its own brings its control set in when it is entered, before it moves") {
  Cast cast;
  cast.write("lib/nods", nods);
  cast.write("main", caller("k.call 'nods'"));
  cast.play({"main"});
  cast.tick();
  CHECK(cast.switches() == std::vector<std::uint32_t>{legs});
  cast.tick(2);
  CHECK(cast.switches() == std::vector<std::uint32_t>{legs, gesture});
  CHECK(cast.snapshot.control_sets == (set_bit(legs) | set_bit(gesture)));
  const auto kind = [&](std::size_t from_end) { return cast.applied[cast.applied.size() - from_end].kind; };
  CHECK(kind(4) == CommandKind::transaction);
  CHECK(kind(3) == CommandKind::switch_set);
  CHECK(kind(2) == CommandKind::set_point);
  cast.tick(20);
  CHECK(cast.host->behavior(0).outcome() == "done");
  CHECK(cast.log.errors == 0);
  CHECK(cast.snapshot.control_sets == (set_bit(legs) | set_bit(gesture)));  // stays until another takes its joints
}

TEST_CASE("each behavior sees the objects of its own control set only, when it runs and in the check") {
  Cast cast;
  cast.write("lib/nods",
             "return k.behavior 'nods' { controls = 'gesture', k.state 'a' { endless = true,\n"
             "enter = function(m) m.legs:set_gains('soft') end } }");
  cast.write("main", caller("k.call 'nods'"));
  const std::string message = "control object 'legs' is not in this behavior's control set, 'gesture'";
  const auto problems = check_behavior(cast.scripts.root, cast.scripts.root / "behaviors/main.lua", cast.robot.catalog);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].file == "behaviors/lib/nods.lua");
  CHECK(problems[0].line == 3);
  CHECK(problems[0].message == message);
  cast.play({"main"});
  cast.tick(4);
  CHECK(cast.host->behavior(0).error().text() == "behaviors/lib/nods.lua:3: " + message);
}

TEST_CASE("a called behavior without a set uses its caller's, and may be called from any") {
  Cast cast;
  cast.write("lib/soft",
             "return k.behavior 'soft' { k.state 'a' { enter = function(m) m.legs:set_gains('soft') end, "
             "endless = true } }");
  cast.write("main", caller("k.call 'soft'"));
  cast.play({"main"});
  cast.tick(5);
  CHECK(cast.switches() == std::vector<std::uint32_t>{legs});
  CHECK(cast.commands(CommandKind::set_parameter) == 10);
}

TEST_CASE("regions may call behaviors on sets of their own, those that share a joint are refused at the call") {
  Cast cast;
  cast.write("lib/nods", nods);
  cast.write("lib/stands", "return k.behavior 'stands' { controls = 'legs', k.final 'b' {} }");
  cast.write("lib/moves", "return k.behavior 'moves' { controls = 'posture', k.final 'b' {} }");
  const auto both = [&](const std::string& other) {
    cast.write("main",
               "return k.behavior 'main' { k.parallel 'p' { k.region 'l' { k.call 'nods' },\nk.region 'r' { "
               "k.call '" +
                   other + "' } }, { on = 'done', to = 'z' }, k.final 'z' {}, initial = 'p' }");
  };
  both("stands");
  cast.play({"main"});
  cast.tick(20);
  CHECK(cast.switches() == std::vector<std::uint32_t>{gesture, legs});
  CHECK(cast.log.errors == 0);
  both("moves");
  const std::string why =
      "behaviors/main.lua:3: behavior 'moves' cannot be active beside behavior 'nods': control sets 'gesture' and "
      "'posture' both drive joint 'l_shoulder_pitch'; the regions of a parallel run on the same control sets, or on "
      "sets without a common joint";
  CHECK(cast.refusal({"main"}) == why);
  const auto problems = check_behavior(cast.scripts.root, cast.scripts.root / "behaviors/main.lua", cast.robot.catalog);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].file + ":3: " + problems[0].message == why);
}

TEST_CASE("behaviors called one after the other may share joints, each takes them from the one before") {
  Cast cast;
  cast.write("lib/nods", nods);
  cast.write("lib/moves", "return k.behavior 'moves' { controls = 'posture', k.state 'x' { endless = true } }");
  cast.write("main",
             "return k.behavior 'main' { initial = 'a', k.state 'a' { k.call 'nods', { on = 'done', to = 'b' } "
             "}, k.state 'b' { k.call 'moves', { after = 0.05, to = 'a' } } }");
  cast.play({"main"});
  cast.tick(40);
  CHECK(cast.switches().size() >= 4);
  CHECK(cast.switches()[0] == gesture);
  CHECK(cast.switches()[1] == posture);
  CHECK(cast.switches()[2] == gesture);
  CHECK(cast.log.errors == 0);
}

TEST_CASE("two behaviors play at the same time on control sets without a common joint") {
  Cast cast;
  cast.write("squats",
             "return k.behavior 'squats' { controls = 'legs', k.state 'a' { endless = true, "
             "enter = function(m) m.legs:move('lean', { time_s = 0.1 }) end } }");
  cast.write("nods", nods);
  cast.play({"squats", "nods"});
  cast.tick();
  CHECK(cast.snapshot.control_sets == (set_bit(legs) | set_bit(gesture)));
  cast.tick(20);
  CHECK(cast.host->behavior(1).outcome() == "done");
  CHECK(cast.log.errors == 0);
}

TEST_CASE("behaviors whose sets share a joint cannot play at the same time, in a list, an order or an event") {
  Cast cast;
  cast.write("all", "return k.behavior 'all' { controls = 'posture', k.state 'a' { endless = true } }");
  cast.write("nods", nods);
  const std::string clash = "control sets 'posture' and 'gesture' both drive joint 'l_shoulder_pitch'";
  CHECK(cast.refusal({"all", "nods"}) == "behaviors that play at the same time: " + clash);

  cast.play({"all"});
  cast.tick();
  PlayOrder order{.kind = PlayOrder::Kind::play, .list = cast.list({"nods"})};
  cast.host->order(order);  // behind it, in its lane
  order.list[0].lane = 1;
  CHECK_THROWS_WITH_AS(cast.host->order(order),
                       "'nods' cannot play beside what plays: control sets 'gesture' and 'posture' both drive joint "
                       "'l_shoulder_pitch'",
                       InputError);
  order.kind = PlayOrder::Kind::replace;
  cast.host->order(order);
  cast.tick(20);
  CHECK(cast.log.errors == 0);

  ScriptHost::Settings settings;
  settings.play = cast.list({"all"});
  order.kind = PlayOrder::Kind::play;
  settings.events = {{.at_ns = 300'000'000, .order = order}};
  cast.open(settings);
  cast.tick(40);
  CHECK(cast.log.errors == 1);
  CHECK(cast.log.messages.back().find("supervisor: 'nods' cannot play beside what plays") == 0);
  CHECK_FALSE(cast.host->finished());
}

TEST_CASE("a reload to another control set switches to it, one that clashes with a neighbour's is refused") {
  Cast cast;
  const auto on = [](const std::string& set) {
    return "return k.behavior 'a' { controls = '" + set + "', k.state 'a' { endless = true } }";
  };
  cast.write("a", on("legs"));
  cast.write("nods", "return k.behavior 'nods' { controls = 'gesture', k.state 'x' { endless = true } }");
  cast.play({"a", "nods"});
  cast.tick(3);
  const auto reload = [&] {
    cast.host->order({.kind = PlayOrder::Kind::reload, .behavior = {"a", {}}, .file = {}});
    cast.tick(2);
  };
  cast.write("a", on("posture"));
  reload();
  CHECK(cast.log.messages.back().find("reload refused, the old version goes on: control sets 'posture' and 'gesture' "
                                      "both drive") != std::string::npos);
  CHECK(cast.snapshot.control_sets == (set_bit(legs) | set_bit(gesture)));

  Cast alone;
  alone.write("a", on("legs"));
  alone.play({"a"});
  alone.tick(3);
  alone.write("a", on("gesture"));
  alone.host->order({.kind = PlayOrder::Kind::reload, .behavior = {"a", {}}, .file = {}});
  alone.tick(2);
  CHECK(alone.switches() == std::vector<std::uint32_t>{legs, gesture});
}

TEST_CASE("a switch that found no place in the queue is asked for again") {
  Cast cast;
  cast.write("a", "return k.behavior 'a' { controls = 'legs', k.state 'a' { endless = true } }");
  cast.play({"a"});
  cast.applying = false;
  cast.sender.begin(0);
  while (cast.queue.free() > 1) {
    cast.sender.begin(0);
    const std::size_t places = std::min<std::size_t>(cast.queue.free(), 200);
    for (std::size_t i = 1; i < places; ++i) REQUIRE(cast.sender.add({.kind = CommandKind::clear_faults}));
    REQUIRE(cast.sender.commit() != 0);
  }
  cast.tick();
  cast.applying = true;
  cast.step();
  CHECK(cast.switches().empty());
  cast.tick(2);
  CHECK(cast.switches() == std::vector<std::uint32_t>{legs});
  cast.tick(3);
  CHECK(cast.switches().size() == 1);
}

}  // namespace machine_sets_test
