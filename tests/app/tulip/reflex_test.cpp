// Switches of the legs on the simulated robot, by reflexes and by states: when they come, and what they do to torques.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "app/program.h"

namespace reflex_test {

using namespace kadans::program;

namespace {

constexpr double limit_Nm = 25, held = 512;

// What a record tells of the switches from the tenth of a second on.
struct Switching {
  int switches = 0;
  int fifths_touched = 0;  // fifths of a second in which something touches a foot
  int ticks_apart = 0;     // in which the legs are held and nothing touches a foot, or the other way round
  int apart_max = 0;       // in one go
  double step_max_Nm = 0;
};

using Rows = std::vector<std::vector<double>>;  // time, contacts of both feet, control sets, six torques

Rows rows_of(const std::string& record, const std::filesystem::path& project) {
  const Outcome csv =
      run("log csv " + record +
              " foot.l_ankle_roll_link.contact foot.r_ankle_roll_link.contact engine.control_sets "
              "'actuation.*_hip_roll.effort_Nm' 'actuation.*_hip_pitch.effort_Nm' 'actuation.*_knee.effort_Nm'",
          project);
  Rows rows = rows_of_table(csv.out);
  REQUIRE(!rows.empty());
  REQUIRE(rows.front().size() == 4 + 6);
  return rows;
}

Switching switching_of(const Rows& rows) {
  Switching found;
  for (std::size_t k = 0, touched = 0; k < rows.size(); ++k) {
    touched = rows[k][1] + rows[k][2] > 0 ? 1 : k % 200 == 0 ? 0 : touched;
    if (k % 200 == 199) found.fifths_touched += static_cast<int>(touched);
  }
  int apart = 0;
  for (std::size_t k = 100; k + 1 < rows.size(); ++k) {
    const bool touched = rows[k][1] + rows[k][2] > 0;
    apart = touched == (rows[k][3] == held) ? 0 : apart + 1;
    found.ticks_apart += apart > 0 ? 1 : 0;
    found.apart_max = std::max(found.apart_max, apart);
    if (rows[k][3] == rows[k - 1][3]) continue;
    ++found.switches;  // computed in this tick, written in the next one
    for (std::size_t joint = 4; joint < rows[k].size(); ++joint)
      found.step_max_Nm = std::max(found.step_max_Nm, std::abs(rows[k + 1][joint] - rows[k][joint]));
  }
  return found;
}

}  // namespace

TEST_CASE("A reflex switches the legs in the tick of the contact, and no torque steps by it") {
  const auto project = project_copy("reflex");
  const Outcome sim = run("sim config/scenarios/touched_feet.json --seed 71 --record reflex.mcap", project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.err);
  const Rows rows = rows_of("reflex.mcap", project);
  REQUIRE(rows.size() == 60'000);
  const Switching found = switching_of(rows);
  CHECK(found.fifths_touched == 300);  // five times a second, for a minute
  CHECK(found.switches >= 600);
  CHECK(found.ticks_apart == 0);
  CHECK(found.step_max_Nm < 0.02 * limit_Nm);
}

TEST_CASE("From the tick of a contact to the torque of the other control set a reflex takes two ticks") {
  const auto project = project_copy("reflex_latency");
  const auto record = [&](const std::string& file) {
    const Outcome sim = run("sim config/scenarios/touched_feet.json --seed 71 --duration 1 --record " + file, project);
    REQUIRE_MESSAGE(sim.exit_code != 2, sim.err);
    return rows_of(file, project);
  };
  const Rows held_rows = record("held.mcap");
  REQUIRE(edit(project / "behaviors/hanging/touched.lua", "c:use(\"held\")", "c:use(\"loose\")"));
  const Rows loose_rows = record("loose.mcap");  // the same, but its reflex changes nothing
  const auto touched = [](const std::vector<double>& row) { return row[1] + row[2] > 0; };
  const auto contact = static_cast<std::size_t>(std::ranges::find_if(held_rows, touched) - held_rows.begin());
  REQUIRE(contact + 2 < held_rows.size());
  CHECK(held_rows[contact - 1][3] != held);
  CHECK(held_rows[contact][3] == held);
  const auto differ = [&](std::size_t row, std::size_t column) {
    return held_rows[row][column] != loose_rows[row][column];
  };
  for (std::size_t joint = 4; joint < held_rows.front().size(); ++joint) {
    for (std::size_t row = 0; row <= contact; ++row) CHECK_FALSE(differ(row, joint));
    CHECK(differ(contact + 1, joint));
  }
}

TEST_CASE("States switch the legs in the behavior tick that sees the contact, and no torque steps by it") {
  const auto project = project_copy("state_switches");
  write(project / "behaviors/hanging/held_or_loose.lua", R"(local k = require "kadans"
local function touched(s) return s.feet.left.contact or s.feet.right.contact end
return k.behavior "held_or_loose" {
  initial = "loose",
  k.state "loose" {
    controls = "loose",
    enter = function(m) m.springs:move("stand", { time_s = 0.05 }) end,
    { when = touched, to = "held" },
  },
  k.state "held" {
    controls = "held",
    enter = function(m, s) m.legs:move({ l_knee = s.joints.l_knee.position_rad }, { time_s = 0.05 }) end,
    { when = function(s) return not touched(s) end, to = "loose" },
  },
}
)");
  const auto scenario = project / "config/scenarios/touched_feet.json";
  REQUIRE(edit(scenario, "\"touched\"]", "\"held_or_loose\"]"));
  REQUIRE(edit(scenario, "== (engine.control_sets == 512)", "== (engine.control_sets == 512) or safety.faults == 0"));
  const Outcome sim =
      run("sim config/scenarios/touched_feet.json --seed 71 --duration 10 --record states.mcap", project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.out);
  CHECK(has(sim.out, "no faults"));
  const Switching found = switching_of(rows_of("states.mcap", project));
  CHECK(found.switches > 40);
  // Up to 10 ms until a behavior tick sees it and one until the switch; a foot that bounces in that tick begins anew,
  // twice at most.
  CHECK(found.apart_max <= 33);
  CHECK(found.step_max_Nm < 0.02 * limit_Nm);
}

}  // namespace reflex_test
