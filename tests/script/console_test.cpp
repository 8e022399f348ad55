// The console: lines of Lua between ticks, commands, completion.
#include "script/console/console.h"

#include <algorithm>

#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

struct Desk : Theatre {
  Desk() {
    robot.catalog.signals.add({"base.height_m", "m", ""}, &height_m);
    robot.catalog.signals.add({"base.tilt_rad", "rad", ""}, &tilt_rad);
    robot.catalog.signals.add({"joint.l_knee.position_rad", "rad", ""}, &tilt_rad);
    scripts.write("behaviors/tulip/nod.lua",
                  "local k = require 'kadans'\nlocal P = k.params { hold_s = 0.5 }\n"
                  "return k.behavior 'nod' { initial = 'a', k.state 'a' { { after = P.hold_s, to = 'b' } }, "
                  "k.final 'b' { outcome = 'done' } }");
    scripts.write("config/robot.json", "{}");
    open({});
    console = std::make_unique<Console>(
        Console::Settings{.root = scripts.root, .folders = {scripts.root / "config/robot.json", "tulip"}},
        robot.catalog, *host);
  }
  Console::Reply type(const std::string& line) {
    std::vector<double> row(robot.catalog.signals.size());
    robot.catalog.signals.gather(row);
    std::vector<double> parameters;
    for (ParameterId id = 0; id < robot.catalog.parameters.size(); ++id)
      parameters.push_back(robot.catalog.parameters.get(id));
    return console->evaluate(line, {snapshot, row, parameters, sender});
  }
  std::string says(const std::string& line) {
    const Console::Reply reply = type(line);
    return (reply.error ? "error: " : "") + reply.text;
  }
  std::vector<std::string> words(const std::string& text) { return console->complete(text).words; }

  double height_m = 0.88, tilt_rad = 0.25;
  std::unique_ptr<Console> console;
};

}  // namespace

TEST_CASE("a line gives its values: numbers, texts, tables, several, or what it prints") {
  Desk desk;
  CHECK(desk.says("1 + 1") == "2");
  CHECK(desk.says("0.1 + 0.2") == "0.3");
  CHECK(desk.says("'a', nil, true") == "a  nil  true");
  CHECK(desk.says("{ 1, 'two', x = { y = 3 } }") == "{ 1, \"two\", x = { y = 3 } }");
  CHECK(desk.says("print 'hello'") == "hello");
  CHECK(desk.says("print 'a' return 7") == "a\n7");
  CHECK(desk.says("   ").empty());
}

TEST_CASE("a line reads signals, joints, parameters, poses and behaviors, as they are now") {
  Desk desk;
  CHECK(desk.says("signals.base.height_m") == "0.88");
  desk.height_m = 0.5;
  CHECK(desk.says("signals.base") == "{ height_m = 0.5, tilt_rad = 0.25 }");
  CHECK(desk.says("signals.joint.l_knee.position_rad") == "0.25");
  CHECK(desk.says("parameters.posture.l_knee.kp_Nm_per_rad") == "100");
  desk.snapshot.joints.joints[3].position_rad = 0.75;
  CHECK(desk.says("s.joints.l_knee.position_rad") == "0.75");
  CHECK(desk.says("k.pose('lean').l_knee") == "0.1");
  CHECK(desk.says("require('kadans').pose('lean').l_knee") == "0.1");
  CHECK(desk.says("behaviors") == "{}");
  desk.says(":play nod");
  desk.tick(1);
  CHECK(desk.says("behaviors.nod.state, behaviors.nod.parameters.hold_s") == "a  0.5");
}

TEST_CASE("globals stay from line to line, and a chunk may take several lines") {
  Desk desk;
  CHECK(desk.says("height = signals.base.height_m").empty());
  CHECK(desk.says("height * 2") == "1.76");
  CHECK(desk.type("function double(x)").incomplete);
  CHECK(desk.type("return 2 * x").incomplete);
  CHECK_FALSE(desk.type("end").incomplete);
  CHECK(desk.says("double(4)") == "8");
}

TEST_CASE("what is wrong is told with the number of the line, and the console goes on") {
  Desk desk;
  CHECK(desk.says("signals.base.hight_m") == "error: console:1: signals has no 'hight_m', did you mean 'height_m'?");
  CHECK(desk.says("x = = 1").find("error: console:2: ") == 0);
  CHECK(desk.says("nothing.field") == "error: console:3: unknown name 'nothing'");
  CHECK(desk.says("singals").find("did you mean 'signals'?") != std::string::npos);
  CHECK(desk.says("signals.base.height_m = 1").find("read-only") != std::string::npos);
  CHECK(desk.says("print 'before' error('mine', 0)") == "error: before\nconsole:6: mine");
  CHECK(desk.says("1") == "1");
}

TEST_CASE("an endless line is stopped by its budget, one that eats memory too") {
  Desk desk;
  CHECK(desk.says("while true do end").find("error: console:1: instruction budget exceeded") == 0);
  CHECK(desk.says("while true do pcall(function() while true do end end) end").find("budget exceeded") !=
        std::string::npos);
  CHECK(desk.says("t = {} for i = 1, 1e6 do t[i] = ('x'):rep(1e5) end").find("error: console:3: ") == 0);
  CHECK(desk.says("t = nil").empty());
  CHECK(desk.says("io, os, debug, ffi").find("unknown name 'io'") != std::string::npos);
  CHECK(desk.says("1") == "1");
}

TEST_CASE("a console only reads until :write, then each line is one transaction") {
  Desk desk;
  const std::string move = "m.posture:move('lean', { time_s = 1 })";
  CHECK(desk.says(move) == "error: console:1: this console only reads: ':write' lets it command");
  CHECK(desk.queue.size() == 0);
  desk.type(":write");
  CHECK(desk.console->writes());
  CHECK(desk.says(move + " m.posture:set_gains('stiff')").empty());
  CHECK(desk.queue.size() == 1 + 24);
  desk.tick(1);
  CHECK(desk.commands(CommandKind::set_point) == 12);
  CHECK(desk.says("p = m.posture").empty());
  CHECK(desk.says("m.posture:move('lean', { time_s = 1 }) error 'no'").find("error: ") == 0);
  CHECK(desk.queue.size() == 0);
  desk.type(":read");
  CHECK(desk.says("p:set_gains('soft')").find("error: this console only reads") == 0);
  CHECK(desk.queue.size() == 0);
  CHECK(desk.says("m:wait(1)").find("error: ") == 0);
}

TEST_CASE("what belongs to a state is refused in a console, whatever is given") {
  Desk desk;
  desk.type(":write");
  for (const char* given : {"", "'base.height_m > 3', function(c) c.posture:hold() end, { within_s = 5 }"})
    CHECK(desk.says("m:on(" + std::string(given) + ")").find("m:on belongs to a state that is active") !=
          std::string::npos);
  for (const char* waits : {"-1", "0/0", "1e300"})
    CHECK(desk.says("m:wait(" + std::string(waits) + ")").find("m:wait takes seconds >= 0") != std::string::npos);
  CHECK(desk.queue.size() == 0);
}

TEST_CASE("faults are cleared by a command with a colon, or in Lua, after :write only") {
  Desk desk;
  CHECK(desk.says(":clear_faults").find("this console only reads: ':write' lets it command") != std::string::npos);
  CHECK(desk.queue.size() == 0);
  desk.type(":write");
  CHECK(desk.says(":clear_faults").empty());
  CHECK(desk.queue.size() == 2);
  CHECK(desk.says("m:clear_faults()") == "true");
  desk.tick(1);
  CHECK(desk.commands(CommandKind::clear_faults) == 2);
}

TEST_CASE("a pause halts what the console moves too") {
  Desk desk;
  desk.type(":write");
  desk.type("m.posture:move('lean', { time_s = 1 })");
  desk.tick(10);
  CHECK(desk.says(":pause").empty());
  desk.tick(1);
  CHECK(desk.commands(CommandKind::cancel_motion) == 12);
}

TEST_CASE("commands with a colon order what plays, a wrong one says what was meant") {
  Desk desk;
  CHECK(desk.says(":play nod, nod").empty());
  desk.tick(2);
  CHECK(desk.says(":status") == "plays\n  nod: in a\n  nod: waits");
  desk.type(":pause");
  desk.tick(2);
  CHECK(desk.says(":status").find("paused") == 0);
  desk.type(":stop");
  desk.tick(1);
  CHECK(desk.says(":status") == "nothing plays\n  nod: stopped\n  nod: stopped");
  CHECK(desk.says(":play nodd").find("error: console:7:7: unknown behavior 'nodd' in behaviors/tulip") == 0);
  CHECK(desk.says(":play nod{hold=1}") ==
        "error: console:8:11: behavior 'nod' takes no argument 'hold', did you mean 'hold_s'?");
  CHECK(desk.says(":plya nod").find("error: unknown command ':plya', did you mean ':play'?") == 0);
  CHECK(desk.says(":stop now") == "error: :stop takes no argument");
  CHECK(desk.type(":run 1.5").run_s == 1.5);
  CHECK(desk.says(":run -1").find("error: ") == 0);
  CHECK(desk.says(":run nan").find("error: ") == 0);
  CHECK(desk.says(":help").find(":replace LIST") != std::string::npos);
  CHECK(desk.type(" :quit").quit);
}

TEST_CASE("names are completed: globals, signals, objects and their methods, joints, commands, behaviors") {
  using Words = std::vector<std::string>;
  Desk desk;
  CHECK(desk.words("sig") == Words{"signals"});
  CHECK(desk.words("print(signals.b") == Words{"signals.base"});
  CHECK(desk.words("signals.base.") == Words{"signals.base.height_m", "signals.base.tilt_rad"});
  CHECK(desk.words("m.post") == Words{"m.posture"});
  CHECK(desk.words("m.posture:set_g") == Words{"m.posture:set_gains"});
  CHECK(desk.words("s.joints.l_kn") == Words{"s.joints.l_knee"});
  CHECK(desk.words("s.joints.l_knee.pos") == Words{"s.joints.l_knee.position_rad"});
  CHECK(desk.words("parameters.posture.r_knee.") == Words{"parameters.posture.r_knee.kp_Nm_per_rad"});
  CHECK(desk.words("math.flo") == Words{"math.floor"});
  CHECK(desk.words("nowhere.at.all").empty());
  CHECK(desk.words("signals.base.height_m.").empty());
  desk.type("my_table = { inner = 1 }");
  CHECK(desk.words("my_table.i") == Words{"my_table.inner"});
  CHECK(desk.words(":pl") == Words{":play"});
  CHECK(desk.words(":re") == Words{":replace", ":resume", ":read"});
  CHECK(desk.words(":play nod, n") == Words{"nod"});
  CHECK(desk.console->complete("x = sig").begin == 4);
  const Words all = desk.words("");
  CHECK(std::find(all.begin(), all.end(), "parameters") != all.end());
}
