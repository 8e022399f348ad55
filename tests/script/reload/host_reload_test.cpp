// Reloads of several behaviors, by time and by saving; and the safe posture after a failure.
#include <doctest/doctest.h>

#include "script/fixture.h"
#include "script/host/script_host.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

std::string says(const std::string& name, const std::string& word) {
  return "local k = require 'kadans'\nreturn k.behavior '" + name + "' { k.state 'a' { during = function() print '" +
         word + "' end } }\n";
}

}  // namespace

TEST_CASE("reloads are events of the run: at their time, for their behavior") {
  Theatre theatre;
  theatre.scripts.write("behaviors/one.lua", says("one", "one"));
  theatre.scripts.write("behaviors/two.lua", says("two", "two"));
  const auto later = theatre.scripts.write("behaviors/later.lua", says("two", "new"));
  const PlayOrder reload{.kind = PlayOrder::Kind::reload, .behavior = {"two", {}}, .file = later};
  theatre.open({.play = {{"behaviors/one.lua", 0}, {"behaviors/two.lua", 1}}, .events = {{20'000'000, reload}}});
  theatre.tick(3);
  CHECK(theatre.log.joined() == "one\ntwo\none\ntwo\nreloaded behaviors/later.lua\none\nnew\n");
}

TEST_CASE("what an editor saves or renames over the file is taken while the behavior plays") {
  Theatre theatre;
  theatre.scripts.write("behaviors/one.lua", says("one", "old"));
  theatre.open({.play = {{"behaviors/one.lua", 0}}});
  theatre.host->watch();
  theatre.tick(1);
  theatre.scripts.write("behaviors/one.lua", says("one", "new"));
  theatre.tick(2);
  const auto other = theatre.scripts.write("behaviors/.one.swp", says("one", "newer"));
  std::filesystem::rename(other, theatre.scripts.root / "behaviors/one.lua");
  theatre.tick(2);
  CHECK(theatre.log.joined() == "old\nold\nreloaded behaviors/one.lua\nnew\nnew\nreloaded behaviors/one.lua\nnewer\n");
}

TEST_CASE("after a script error the robot holds, then goes to the safe posture, in one transaction") {
  Theatre theatre;
  theatre.scripts.write(
      "behaviors/bad.lua",
      "local k = require 'kadans'\nreturn k.behavior 'bad' { controls = 'posture', k.state 'a' { enter = "
      "function() error 'x' end } }");
  theatre.open({.play = {{"behaviors/bad.lua", 0}}, .safe = {.pose = "stand", .after_s = 0.5, .time_s = 1.5}});
  theatre.applying = false;
  theatre.tick(50);
  CHECK(theatre.sender.sent() == 0);
  CHECK_FALSE(theatre.host->in_safe_posture());
  theatre.tick(1);
  CHECK(theatre.host->in_safe_posture());
  CHECK(theatre.sender.sent() == 12);
  CHECK(theatre.queue.peek(1).duration_s == 1.5);
  theatre.tick(100);
  CHECK(theatre.sender.sent() == 12);
}

TEST_CASE("what another behavior still moves is left to it") {
  Theatre theatre;
  theatre.scripts.write(
      "behaviors/bad.lua",
      "local k = require 'kadans'\nreturn k.behavior 'bad' { controls = 'posture', k.state 'a' { enter = "
      "function() error 'x' end } }");
  theatre.scripts.write(
      "behaviors/good.lua",
      "local k = require 'kadans'\nreturn k.behavior 'good' { controls = 'posture', k.state 'a' {} }");
  theatre.open({.play = {{"behaviors/bad.lua", 0}, {"behaviors/good.lua", 1}},
                .safe = {.pose = "stand", .after_s = 0.1, .time_s = 1}});
  theatre.tick(50);
  CHECK(theatre.sender.sent() == 0);
}

TEST_CASE("memory, instructions and state of each behavior are signals, a name that plays twice gets a number") {
  Theatre theatre;
  theatre.scripts.write(
      "behaviors/one.lua",
      "local k = require 'kadans'\nreturn k.behavior 'one' { initial = 'a', k.state 'a' { { after = 0, to "
      "= 'b' } }, k.state 'b' { during = function() for i = 1, 5000 do end end } }");
  theatre.open({.play = {{"behaviors/one.lua", 0}, {"behaviors/one.lua", 1}}});
  SignalTable signals;
  theatre.host->declare_signals(signals);
  theatre.tick(3);
  std::vector<double> row(signals.size());
  signals.gather(row);
  const auto value = [&](const char* name) { return row[signals.find(name).value()]; };
  CHECK(value("behavior.one.heap_bytes") > 20e3);
  CHECK(value("behavior.one.heap_bytes") == static_cast<double>(theatre.host->behavior(0).heap_bytes()));
  CHECK(value("behavior.one.instructions") == 5000);
  CHECK(value("behavior.one.gc_pause_ns") == 0);
  CHECK(value("behavior.one_2.state") == 2);
}
