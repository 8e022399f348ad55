// The whole robot while its control sets take turns: TULip squats, and its balance comes and goes, up to fifty times a
// second.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "app/program.h"

namespace switching_test {

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
      { to = "without" },
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
  const std::string line = csv.out.substr(0, csv.out.find('\n'));
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
  for (const std::vector<double>& row : rows_of_table(csv.out)) {
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

// Two sets that take turns in states of a behavior; each sends its object where it shall be in the transaction of the
// switch and in each tick.
constexpr const char* turns = R"(local k = require "kadans"
local P = k.params {
  period_s = { 0.04, min = 0, max = 100, unit = "s", doc = "of two switches" },
  second   = { 0, min = 0, max = 1, doc = "whether the other set is there first" },
}
local brisk = { velocity_max_rad_s = 1.5, acceleration_max_rad_s2 = 8 }
local function over(_, m) return m.time_s >= P.period_s / 2 - 0.001 end
local function lead(object, s)
  local soft = math.min(1, 2 * s.time_s)
  local at_rad = 0.3 * soft * soft * math.sin(1.4 * math.pi * s.time_s)
  object:follow({ pan = at_rad, tilt = at_rad }, brisk)
end
return k.behavior "turns" {
  initial = "choose",
  k.state "choose" {
    { when = function() return P.second > 0.5 end, to = "effort" },
    { to = "position" },
  },
  k.state "position" {
    controls = "position",
    enter    = function(m, s) lead(m.profile, s) end,
    during   = function(m, s) lead(m.profile, s) end,
    { when = over, to = "effort" },
  },
  k.state "effort" {
    controls = "effort",
    enter    = function(m, s) lead(m.torque, s) end,
    during   = function(m, s) lead(m.torque, s) end,
    { when = over, to = "position" },
  },
}
)";

constexpr const char* hanging = R"(local k = require "kadans"
local function over(_, m) return m.time_s > 0.019 end
local function go(object) object:move("stand", { time_s = 0.5 }) end
return k.behavior "turns" {
  initial = "held",
  k.state "held" { controls = "held", enter = function(m) go(m.legs) end, { when = over, to = "loose" } },
  k.state "loose" { controls = "loose", enter = function(m) go(m.springs) end, { when = over, to = "held" } },
}
)";

std::string scenario_of(const std::string& robot, int duration_s) {
  return R"({ "name": "turns", "doc": "Control sets take turns.", "robot": "config/)" + robot +
         R"(/robot.json", "duration_s": )" + std::to_string(duration_s) + R"(, "behaviors": ["turns"],
  "checks": [ { "name": "no faults", "kind": "always", "that": "safety.faults == 0" } ] })";
}

struct Turns {
  int switches = 0;
  double error_rad = 0;       // RMS of the worse joint
  double energy_rad2_s2 = 0;  // the largest sum of squared joint velocities
};

// The 0.7 Hz of `turns`, from 1.5 s on.
Turns turn(const std::filesystem::path& project, double period_s, int second) {
  const Outcome sim = run("sim config/scenarios/turns.json --seed 1 --record turns.mcap --play 'turns { period_s = " +
                              std::to_string(period_s) + ", second = " + std::to_string(second) + " }'",
                          project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.out);
  const Outcome csv =
      run("log csv turns.mcap engine.control_sets 'joint.*.position_rad' 'joint.*.velocity_rad_s'", project);
  Turns found;
  double squares[2]{}, rows = 0, sets = 0;
  for (const std::vector<double>& row : rows_of_table(csv.out)) {
    REQUIRE(row.size() == 6);
    found.switches += row[1] != std::exchange(sets, row[1]) ? 1 : 0;
    if (row[0] < 1.5) continue;
    for (const std::size_t joint : {0U, 1U}) {
      squares[joint] += std::pow(0.3 * std::sin(1.4 * std::numbers::pi * row[0]) - row[2 + joint], 2);
    }
    found.energy_rad2_s2 = std::max(found.energy_rad2_s2, row[4] * row[4] + row[5] * row[5]);
    ++rows;
  }
  found.error_rad = std::sqrt(std::max(squares[0], squares[1]) / rows);
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

TEST_CASE("JIWIY follows as well while its control sets take turns, at whatever period, up to 50 switches a second") {
  const auto project = project_copy("jiwiy_switching");
  write(project / "behaviors/jiwiy/turns.lua", turns);
  write(project / "config/scenarios/turns.json", scenario_of("jiwiy", 8));
  const Turns first = turn(project, 100, 0), second = turn(project, 100, 1);
  for (const double period_s : {0.04, 0.06, 0.1, 0.2, 0.42, 0.6, 1.0}) {
    CAPTURE(period_s);
    const Turns switched = turn(project, period_s, 0);
    CHECK(switched.switches >= static_cast<int>(1.9 * 8 / period_s) - 1);
    CHECK(switched.error_rad <= 1.2 * std::max(first.error_rad, second.error_rad));
    CHECK(switched.energy_rad2_s2 <= 1.2 * std::max(first.energy_rad2_s2, second.energy_rad2_s2));
  }
}

TEST_CASE("TULip hangs as calmly while its control sets take turns fifty times a second for twenty seconds") {
  const auto project = project_copy("hanging_switching");
  write(project / "behaviors/hanging/turns.lua", hanging);
  write(project / "config/scenarios/turns.json",
        scenario_of("hanging", 20));  // later a leg may have walked to its end stop
  const Outcome sim = run("sim config/scenarios/turns.json --seed 1 --record turns.mcap", project);
  CHECK_MESSAGE(sim.exit_code == 0, sim.out);
  const Outcome csv = run("log csv turns.mcap engine.control_sets 'joint.*.velocity_rad_s'", project);
  int switches = 0;
  double sets = 0, fastest_rad_s = 0;
  for (const std::vector<double>& row : rows_of_table(csv.out)) {
    switches += row[1] != std::exchange(sets, row[1]) ? 1 : 0;
    for (std::size_t i = 2; row[0] > 1 && i < row.size(); ++i)
      fastest_rad_s = std::max(fastest_rad_s, std::abs(row[i]));
  }
  CHECK(switches >= 950);
  CHECK(fastest_rad_s < 0.5);
}

}  // namespace switching_test
