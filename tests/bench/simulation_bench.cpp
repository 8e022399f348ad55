#include "kadans/app/assembly.h"
#include "report.h"

namespace kadans::bench {

// The squat as a scenario: plant, control and behaviors, without a record.
void bench_simulation(Report& report) {
  ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  std::vector<double> factors;
  for (int run = 0; run < 5; ++run) {
    RunLog log;
    Assembly robot(scenario, 1, log);
    const RunParts parts = robot.parts();
    Checks checks(robot.catalog().signals);
    factors.push_back(run_scenario(parts, 4.0, checks, {}).realtime_factor);
  }
  report.add("sim_realtime_factor", "squat, simulated seconds per second", median(factors), "x");
}

}  // namespace kadans::bench
