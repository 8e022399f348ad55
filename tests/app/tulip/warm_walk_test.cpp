// TULip walks higher once a motor is warm, so that its knees bear the weight with less torque.
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "app/program.h"

namespace warm_walk_test {

using namespace kadans::program;

namespace {

// Mean height of the centre of mass over the foot that stands, in the last two of twelve seconds.
double height_m(const std::filesystem::path& project) {
  const Outcome sim = run("sim config/sweeps/scenarios/walk_straight.json --duration 12 --record walk.mcap", project);
  REQUIRE_MESSAGE(sim.exit_code == 0, sim.err);
  double sum_m = 0;
  const std::vector<std::vector<double>> rows =
      rows_of_table(run("log csv walk.mcap control.walk.height_m --from 10", project).out);
  REQUIRE(rows.size() > 1000);
  for (const std::vector<double>& row : rows) sum_m += row.back();
  return sum_m / static_cast<double>(rows.size());
}

}  // namespace

TEST_CASE("walk is higher once a motor is warm") {
  const std::filesystem::path project = project_copy("warm_walk");
  const double cold_m = height_m(project);
  REQUIRE(edit(project / "config/tulip/robot.json", "\"warm_C\": 95", "\"warm_C\": 30"));
  CHECK(height_m(project) > cold_m + 0.01);
}

}  // namespace warm_walk_test
