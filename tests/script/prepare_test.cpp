#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

// Counts what runs, draws random numbers, keeps a table between ticks, reads fields one after the other, and moves.
const char* const watchful = R"(
local k = require "kadans"
local kept, guards = nil, 0
return k.behavior "watchful" {
  controls = "posture",
  initial = "a",
  vars = { ticks = 0 },
  during = function(m, s)
    m.vars.ticks = m.vars.ticks + 1
    kept = kept or s
    print(m.vars.ticks, guards, math.random(), s.time_s, kept.joints.l_knee.position_rad,
          m.vars.ticks > 5 and s.base.pitch_rad or 0)
  end,
  k.state "a" {
    run = function(m) m.posture:move("lean", { time_s = 0.1 }):wait() end,
    { when = function(s) guards = guards + 1 return s.joints.l_knee.position_rad > 1e6 end, to = "b" },
    { on = "run.done", to = "b" },
  },
  k.state "b" { { after = 0.1, to = "a" } },
}
)";

std::string play(bool prepared) {
  Stage stage(watchful);
  for (int i = 0; i < 40; ++i) {
    stage.snapshot.joints.joints[3].position_rad = 0.01 * i;
    Snapshot newest = stage.snapshot;
    newest.joints.joints[3].position_rad = 99;  // a tick later than what the tick is going to see
    newest.time_ns += 5'000'000;
    if (prepared) stage.behavior->prepare(newest);
    stage.tick();
  }
  std::string all = stage.said() + stage.behavior->error().text();
  for (const std::string& each : stage.log.transitions) all += each + "\n";
  for (const Command& each : stage.applied)
    all += std::to_string(each.time_ns) + " " + std::to_string(each.value) + "\n";
  return all;
}

}  // namespace

TEST_CASE("Preparing a tick changes nothing that a behavior says or does") {
  const std::string bare = play(false);
  CHECK(bare.find("nil") == std::string::npos);
  CHECK(bare.size() > 1000);
  CHECK(play(true) == bare);
}

TEST_CASE("Preparing a tick does not take back the error of a behavior that failed") {
  Stage stage(on_enter("error('no')"));
  CHECK_FALSE(stage.tick());
  const std::string why = stage.behavior->error().text();
  stage.behavior->prepare(stage.snapshot);
  CHECK(stage.behavior->failed());
  CHECK(stage.behavior->error().text() == why);
}
