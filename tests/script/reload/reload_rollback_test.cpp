// A new version is on probation for a second; and a thousand reloads leave nothing behind.
#include <cstdlib>

#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

std::string chart(const std::string& body) {
  return "local k = require 'kadans'\nreturn k.behavior 'test' {\n" + body + "\n}\n";
}

Behavior::Reload reload(Stage& stage, const std::string& text) {
  stage.scripts.write("behaviors/test.lua", text);
  return stage.behavior->reload(stage.snapshot, stage.sender);
}

const std::string counts = chart(
    "vars = { n = 0 }, k.state 'a' { run = function(m) while true do m.vars.n = m.vars.n + 1 m:wait(0) end end }");

std::string breaks_after(double seconds) {
  return chart("vars = { n = 0 }, k.state 'a' { during = function(m, s)\nif m.time_s > " + std::to_string(seconds) +
               " then error 'broken' end end }");
}

// So many in scripts/test; all of them with KADANS_SOAK=1.
int reloads() { return std::getenv("KADANS_SOAK") != nullptr ? 1000 : 50; }

}  // namespace

TEST_CASE("a version that errors in its first second is taken back: the old one goes on where it was, with its vars") {
  Stage stage(counts);
  stage.tick(10);
  CHECK(reload(stage, breaks_after(0.5)) == Behavior::Reload::taken);
  stage.tick(100);
  CHECK_FALSE(stage.behavior->failed());
  CHECK(stage.log.errors == 0);
  CHECK(stage.said().find("new version taken back, the old one goes on: behaviors/test.lua:4: broken") !=
        std::string::npos);
  CHECK(stage.behavior->reload(stage.snapshot, stage.sender) == Behavior::Reload::unchanged);  // not tried again
  CHECK(reload(stage, counts + "--") == Behavior::Reload::taken);
  CHECK(stage.tick(10));
}

TEST_CASE("a version that loops in its first second is taken back too") {
  Stage stage(counts);
  stage.tick(2);
  CHECK(reload(stage, chart("k.state 'a' { during = function() while true do end end }")) == Behavior::Reload::taken);
  CHECK(stage.tick(20));
  CHECK(stage.said().find("taken back, the old one goes on: behaviors/test.lua:3: instruction budget exceeded") !=
        std::string::npos);
}

TEST_CASE("a version that errors after its first second stops the behavior") {
  Stage stage(counts);
  stage.tick(2);
  CHECK(reload(stage, breaks_after(1.2)) == Behavior::Reload::taken);
  stage.tick(200);
  CHECK(stage.behavior->failed());
}

TEST_CASE("what the new version entered it leaves, what the old one had left it enters again") {
  Stage stage(
      chart("initial = 'a', k.state 'a' { enter = function() print 'in a' end, exit = function() print 'out a' end }"));
  stage.tick(2);
  CHECK(reload(stage, chart("initial = 'b', k.state 'b' { enter = function() print 'in b' end,\n"
                            "exit = function() print 'out b' end, { after = 0.02, to = 'c' } },\n"
                            "k.state 'c' { enter = function() print(nil .. '') end }")) == Behavior::Reload::taken);
  stage.tick(10);
  CHECK(stage.said().find("in a\nout a\nreloaded behaviors/test.lua\nin b\nout b\nnew version taken back") == 0);
  CHECK(stage.log.messages.back() == "test: in a");
  CHECK(stage.behavior->state() == "a");
}

TEST_CASE("many reloads of another text leave neither memory nor refused commands behind") {
  Stage stage(KADANS_SOURCE_DIR, "behaviors/tulip/squat.lua");
  stage.tick(300);
  const std::string text = [] {
    std::ifstream file(KADANS_SOURCE_DIR "/behaviors/tulip/squat.lua");
    return std::string(std::istreambuf_iterator<char>(file), {});
  }();
  std::filesystem::copy(KADANS_SOURCE_DIR "/behaviors/lib", stage.scripts.root / "behaviors/tulip");
  const auto take = [&](int i) {
    const auto file = stage.scripts.write("behaviors/tulip/squat.lua", text + (i % 2 == 0 ? "-- a" : "-- b"));
    return stage.behavior->reload(stage.snapshot, stage.sender, file);
  };
  REQUIRE(take(0) == Behavior::Reload::taken);
  stage.tick(5);
  const auto before = static_cast<double>(stage.behavior->heap_bytes());
  for (int i = 1; i <= reloads(); ++i) {
    REQUIRE(take(i) == Behavior::Reload::taken);
    REQUIRE(stage.tick(5));
  }
  CHECK(static_cast<double>(stage.behavior->heap_bytes()) == doctest::Approx(before).epsilon(0.05));
  CHECK(stage.behavior->transactions_refused() == 0);
  CHECK(stage.sender.refused() == 0);
}
