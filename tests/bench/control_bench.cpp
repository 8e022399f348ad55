#include <memory>

#include "kadans/app/assembly.h"
#include "kadans/telemetry/recorder.h"
#include "kadans/testing/allocation_count.h"
#include "report.h"

namespace kadans::bench {
namespace {

ScenarioConfig tulip_on_ideal_plant() {
  ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  scenario.plant = PlantKind::ideal;
  scenario.behaviors.clear();
  return scenario;
}

}  // namespace

// One control tick with everything but the plant: estimate, safety, 12 PID laws, snapshot, record.
void bench_control(Report& report) {
  const ScenarioConfig scenario = tulip_on_ideal_plant();
  RunLog log;
  Assembly robot(scenario, 1, log);
  Recorder recorder(robot.catalog().signals);
  robot.record_to(&recorder);
  const RunParts parts = robot.parts();
  std::int64_t time_ns = 0;
  std::vector<double> ticks;
  std::uint64_t allocations = 0;
  constexpr int batch = 100, batches = 500;
  for (int i = 0; i < batches; ++i) {
    double began = 0, ended = 0;
    {
      const kadans::testing::AllocationCount heap;
      began = now_ns();
      for (int j = 0; j < batch; ++j) {
        parts.control.tick(time_ns, 0.001);
        time_ns += 1'000'000;
      }
      ended = now_ns();
      allocations += static_cast<std::uint64_t>(heap.count());
    }
    ticks.push_back((ended - began) / batch);
    parts.behaviors.tick(time_ns);
    (void)recorder.drain();
  }
  report.add("control_tick_ns.14", "control tick of TULip: estimate, safety, 12 PID, record", median(ticks), "ns");
  report.add("control_tick_allocations", "heap allocations in these ticks", static_cast<double>(allocations), "");
}

}  // namespace kadans::bench
