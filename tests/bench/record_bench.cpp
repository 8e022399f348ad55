#include "kadans/app/assembly.h"
#include "kadans/telemetry/recorder.h"
#include "report.h"

namespace kadans::bench {

// What recording all signals of TULip costs the control thread.
void bench_record(Report& report) {
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  RunLog log;
  Assembly robot(scenario, 1, log);
  Recorder recorder(robot.catalog().signals);
  const std::vector<double> row(robot.catalog().signals.size(), 0.5);
  std::uint64_t tick = 0;
  std::vector<double> each;
  for (int i = 0; i < 300; ++i) {
    constexpr int calls = 100;
    const double began = now_ns();
    for (int j = 0; j < calls; ++j, ++tick) recorder.record(tick, static_cast<std::int64_t>(tick) * 1'000'000, row);
    each.push_back((now_ns() - began) / calls);
    (void)recorder.drain();
  }
  report.add("record_tick_ns", "record() of " + std::to_string(row.size()) + " signals", median(each), "ns");
}

}  // namespace kadans::bench
