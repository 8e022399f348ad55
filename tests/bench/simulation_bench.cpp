#include "kadans/app/assembly.h"
#include "report.h"

namespace kadans::bench {

// The squat, plant included, without a record; and what of it the plant's step takes.
void bench_simulation(Report& report) {
  ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  std::vector<double> factors, steps_us;
  for (int run = 0; run < 5; ++run) {
    RunLog log;
    Assembly robot(scenario, 1, log);
    const RunParts parts = robot.parts();
    Checks checks(robot.catalog().signals);
    factors.push_back(run_scenario(parts, 4.0, checks, {}).realtime_factor);
    steps_us.push_back(1e-3 * time_ns([&] { parts.plant.step(1'000'000); }, 10, 50));
  }
  report.add("sim_realtime_factor", "squat, simulated seconds per second", median(factors), "x");
  report.add("plant_step_us.kadans", "one step of the plant, TULip standing on its last torques", median(steps_us),
             "us");
}

}  // namespace kadans::bench
