// TULip walks in a limit cycle: its legs change their control objects at each landing, in the tick of the contact.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "app/program.h"

namespace walk_cycle_test {

using namespace kadans::program;

namespace {

constexpr double limit_Nm = 25;
constexpr std::size_t sets_column = 3, torques_from = 4;

using Rows = std::vector<std::vector<double>>;  // time, contact left and right, control sets, the legs' torques

Rows walked(const std::filesystem::path& project) {
  const Outcome sim =
      run("sim config/scenarios/walk_cycle.json --play walk_cycle --duration 6 --record cycle.mcap", project);
  REQUIRE_MESSAGE(sim.exit_code != 2, sim.err);
  const Outcome csv =
      run("log csv cycle.mcap foot.l_ankle_roll_link.contact foot.r_ankle_roll_link.contact engine.control_sets "
          "'actuation.*_hip_*.effort_Nm' 'actuation.*_knee.effort_Nm' 'actuation.*_ankle_pitch.effort_Nm'",
          project);
  Rows rows = rows_of_table(csv.out);
  REQUIRE(rows.size() == 6000);
  REQUIRE(rows.front().size() == torques_from + 10);
  return rows;
}

struct Changes {
  int all = 0;
  int without_contact = 0;  // in whose tick the foot that swung does not touch the ground
  double step_max_Nm = 0;   // from the torque in that tick to the next, the first of the new objects
  double next_max_Nm = 0;   // from there to the one after
};

// From the second switch on: the first one is from standing.
Changes changes_of(const Rows& rows) {
  Changes found;
  bool walks = false;
  for (std::size_t k = 1; k + 2 < rows.size(); ++k) {
    if (rows[k][sets_column] == rows[k - 1][sets_column]) continue;
    if (!std::exchange(walks, true)) continue;
    ++found.all;
    if (!(rows[k][1] > 0 && rows[k][2] > 0)) ++found.without_contact;
    for (std::size_t joint = torques_from; joint < rows[k].size(); ++joint) {
      found.step_max_Nm = std::max(found.step_max_Nm, std::abs(rows[k + 1][joint] - rows[k][joint]));
      found.next_max_Nm = std::max(found.next_max_Nm, std::abs(rows[k + 2][joint] - rows[k + 1][joint]));
    }
  }
  return found;
}

}  // namespace

TEST_CASE("The legs of walk_cycle change their parts in the tick of the landing, and no torque steps by it") {
  const Changes found = changes_of(walked(project_copy("walk_cycle")));
  CHECK(found.all >= 18);
  CHECK(found.without_contact == 0);
  CHECK(found.step_max_Nm < 0.01 * limit_Nm);
  CHECK(found.next_max_Nm < 0.1 * limit_Nm);  // the landing itself
}

TEST_CASE("Without the bumpless switch the legs of walk_cycle would change their parts by a step in torque") {
  const auto project = project_copy("walk_cycle_step");
  REQUIRE(edit(project / "config/tulip/robot.json", "  \"control\": {\n",
               "  \"control\": {\n    \"switch_fade_s\": 0.001, \"switch_step_max\": 1,\n"));
  REQUIRE(edit(project / "behaviors/tulip/walk_cycle.lua", "fade_s, trim = 0.029, 0.2", "fade_s, trim = 0, 0.2"));
  CHECK(changes_of(walked(project)).next_max_Nm > 0.2 * limit_Nm);
}

}  // namespace walk_cycle_test
