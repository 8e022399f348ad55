// The whole robot while its control sets take turns: TULip squats, and its balance comes and goes, up to fifty times a
// second.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "program.h"

using namespace kadans::program;

namespace {

constexpr const char* behavior = R"(local k = require "kadans"
local legs = require "legs"
local P = k.params {
  period_s = { 0.04, min = 0, max = 100, unit = "s", doc = "of two switches" },
  balanced = { 1, min = 0, max = 1, doc = "whether the balance is there first" },
}
local stand = k.pose "stand"
local down = legs.lowered(stand, { "l_", "r_" }, 0.275, 0.275, 0.1)
local function over(_, m) return m.time_s >= P.period_s / 2 - 0.001 end
return k.behavior "switched" {
  controls = "posture",
  initial  = "go",
  k.state "go" {
    initial = "choose",
    run = function(m)
      m.posture:set_gains("stiff")
      m.posture:move("stand", { time_s = 0.5 }):wait()
      while true do
        m.posture:move(down, { time_s = 1 }):wait()
        m:wait(0.3)
        m.posture:move("stand", { time_s = 1 }):wait()
        m:wait(0.3)
      end
    end,
    k.state "choose" {
      { when = function() return P.balanced > 0.5 end, to = "with" },
      { when = function() return true end, to = "without" },
    },
    k.state "without" { controls = "posture", { when = over, to = "with" } },
    k.state "with" { controls = "balanced", { when = over, to = "without" } },
  },
}
)";

constexpr const char* scenario = R"({
  "name": "switched", "doc": "TULip squats while its control sets take turns.", "robot": "config/tulip/robot.json",
  "duration_s": 8, "behaviors": ["switched"],
  "checks": [
    { "name": "no faults", "kind": "always", "that": "safety.faults == 0" },
    { "name": "torques and joints within limits", "kind": "always",
      "that": "plant.limits.torque_share <= 1 and plant.limits.position_rad >= 0" }
  ]
}
)";

struct Squat {
  double error_rad = 0;       // RMS of all joints of the posture
  double energy_rad2_s2 = 0;  // the largest sum of squared joint velocities
  double tilt_rad = 0;        // the largest of the trunk
  int switches = 0;
};

Squat squat(const std::filesystem::path& project, double period_s, int balanced) {
  const Outcome sim =
      run("sim config/scenarios/switched.json --seed 1 --record switched.mcap --play 'switched { period_s = " +
              std::to_string(period_s) + ", balanced = " + std::to_string(balanced) + " }'",
          project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.out);
  const Outcome csv =
      run("log csv switched.mcap engine.control_sets plant.base.tilt_rad 'control.posture.*.error_rad' "
          "'joint.*.velocity_rad_s'",
          project);
  std::istringstream lines(csv.out);
  std::string line;
  std::getline(lines, line);
  const auto named = [&line](const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = line.find(part); at != std::string::npos; at = line.find(part, at + 1)) ++count;
    return count;
  };
  const std::size_t errors = named(".error_rad"), velocities = named(".velocity_rad_s");
  REQUIRE(errors == 12);
  REQUIRE(velocities == 14);
  Squat found;
  double squares = 0, rows = 0, sets_before = 0;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    found.switches += row[1] != sets_before ? 1 : 0;
    sets_before = row[1];
    if (row[0] < 0.5) continue;
    found.tilt_rad = std::max(found.tilt_rad, std::abs(row[2]));
    double energy = 0;
    for (std::size_t i = 0; i < errors; ++i) squares += row[3 + i] * row[3 + i];
    for (std::size_t i = 0; i < velocities; ++i) energy += row[3 + errors + i] * row[3 + errors + i];
    found.energy_rad2_s2 = std::max(found.energy_rad2_s2, energy);
    ++rows;
  }
  found.error_rad = std::sqrt(squares / rows / static_cast<double>(errors));
  return found;
}

}  // namespace

TEST_CASE("TULip squats as well while its control sets take turns, at whatever period, up to 50 switches a second") {
  const auto project = project_copy("switching");
  write(project / "behaviors/tulip/switched.lua", behavior);
  write(project / "config/scenarios/switched.json", scenario);
  const Squat without = squat(project, 100, 0), with = squat(project, 100, 1);
  for (const double period_s : {0.04, 0.06, 0.1, 0.2, 0.4, 0.56, 0.8, 1.6}) {
    CAPTURE(period_s);
    const Squat switched = squat(project, period_s, 1);
    CHECK(switched.switches >= static_cast<int>(1.9 * 8 / period_s) - 1);
    CHECK(switched.error_rad <= 1.2 * std::max(without.error_rad, with.error_rad));
    CHECK(switched.energy_rad2_s2 <= 1.2 * std::max(without.energy_rad2_s2, with.energy_rad2_s2));
    CHECK(switched.tilt_rad <= 1.2 * std::max(without.tilt_rad, with.tilt_rad));
  }
}
