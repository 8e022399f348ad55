// Switches of the legs on the simulated robot, by reflexes and by states: when they come, and what they do to torques.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "program.h"

using namespace kadans::program;

namespace {

constexpr double limit_Nm = 25, held = 4;

// What a record tells of the switches from the tenth of a second on.
struct Switching {
  int switches = 0;
  int ticks_apart = 0;  // in which the legs are held and nothing touches a foot, or the other way round
  int apart_max = 0;    // in one go
  double step_max_Nm = 0;
};

Switching switching_of(const std::string& record, const std::filesystem::path& project) {
  const Outcome csv =
      run("log csv " + record +
              " foot.l_ankle_roll_link.contact foot.r_ankle_roll_link.contact engine.control_sets "
              "'actuation.*_hip_roll.effort_Nm' 'actuation.*_hip_pitch.effort_Nm' 'actuation.*_knee.effort_Nm'",
          project);
  std::istringstream lines(csv.out);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("time_s")) continue;
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
  }
  REQUIRE(rows.size() == 10'000);
  REQUIRE(rows.front().size() == 4 + 6);
  Switching found;
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
  const Outcome sim =
      run("sim config/scenarios/touched_feet.json --seed 71 --duration 10 --record reflex.mcap", project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.err);
  const Switching found = switching_of("reflex.mcap", project);
  CHECK(found.switches > 40);
  CHECK(found.ticks_apart == 0);
  CHECK(found.step_max_Nm < 0.02 * limit_Nm);
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
  REQUIRE(edit(scenario, "== (engine.control_sets == 4)", "== (engine.control_sets == 4) or safety.faults == 0"));
  const Outcome sim =
      run("sim config/scenarios/touched_feet.json --seed 71 --duration 10 --record states.mcap", project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.out);
  CHECK(has(sim.out, "no faults"));
  const Switching found = switching_of("states.mcap", project);
  CHECK(found.switches > 40);
  // Up to 10 ms until a behavior tick sees it and one until the switch; a foot that bounces in that tick begins anew.
  CHECK(found.apart_max <= 22);
  CHECK(found.step_max_Nm < 0.02 * limit_Nm);
}
