// Reflexes on the simulated robot: what an armed transaction does to the torques, and when.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "program.h"

using namespace kadans::program;

TEST_CASE("A reflex switches the legs in the tick of the contact, and no torque steps by it") {
  const auto project = project_copy("reflex");
  const Outcome sim =
      run("sim config/scenarios/touched_feet.json --seed 71 --duration 10 --record reflex.mcap", project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.err);
  const Outcome csv =
      run("log csv reflex.mcap foot.l_ankle_roll_link.contact foot.r_ankle_roll_link.contact engine.control_sets "
          "'actuation.*_hip_roll.effort_Nm' 'actuation.*_hip_pitch.effort_Nm' 'actuation.*_knee.effort_Nm'",
          project);
  constexpr double limit_Nm = 25, held = 4;
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
  int switches = 0, late = 0;
  double step_max_Nm = 0;
  for (std::size_t k = 100; k + 1 < rows.size(); ++k) {
    const bool touched = rows[k][1] + rows[k][2] > 0;
    late += touched == (rows[k][3] == held) ? 0 : 1;
    if (rows[k][3] == rows[k - 1][3]) continue;
    ++switches;  // computed in this tick, written in the next one
    for (std::size_t joint = 4; joint < rows[k].size(); ++joint)
      step_max_Nm = std::max(step_max_Nm, std::abs(rows[k + 1][joint] - rows[k][joint]));
  }
  CHECK(switches > 40);
  CHECK(late == 0);
  CHECK(step_max_Nm < 0.02 * limit_Nm);
}
