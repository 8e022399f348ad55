#include <filesystem>

#include <unistd.h>

#include "app/assembly/assembly.h"
#include "app/sim/input_files.h"
#include "kadans/signal/random.h"
#include "report.h"
#include "telemetry/record/input_stream.h"
#include "telemetry/record/recorded_inputs.h"
#include "telemetry/record/recorder.h"

namespace kadans::bench {
namespace {

// What the thread that drains pays for a tick of so many signals, each of which is noise in each tick: file, or memory
// of the flight recorder.
void bench_drain(Report& report, const SignalTable& signals, bool flight) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("kadans_bench_" + std::to_string(getpid()) + ".mcap");
  Recorder recorder(signals, {}, {.kept_s = flight ? 30.0 : 0.0});
  if (!flight && !recorder.open(file.string())) return;
  RandomStream random(1, "noise");
  std::vector<double> row(signals.size());
  std::vector<double> each;
  std::uint64_t tick = 0;
  for (int i = 0; i < 300; ++i) {
    constexpr int ticks = 20;
    for (int j = 0; j < ticks; ++j, ++tick) {
      for (double& value : row) value = random.normal();
      recorder.record(tick, static_cast<std::int64_t>(tick) * 1'000'000, row);
    }
    const double began = now_ns();
    (void)recorder.drain();
    each.push_back((now_ns() - began) / ticks);
  }
  double sum = 0;
  for (const double ns : each) sum += ns / static_cast<double>(each.size());
  const std::string what = flight ? "keeping for the flight recorder" : "writing";
  report.add(flight ? "record_flight_us" : "record_write_us",
             what + " a tick of " + std::to_string(row.size()) + " signals that are noise", sum * 1e-3, "us");
  (void)recorder.close();
  std::filesystem::remove(file);
}

}  // namespace

// What recording all signals of TULip costs the control thread, what the inputs of its ticks cost beside them, and what
// the thread that drains pays.
void bench_record(Report& report) {
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  RunLog log;
  Assembly robot(scenario, 1, log);
  const SignalTable& signals = robot.catalog().signals;
  Recorder plain(signals), repeatable(signals);
  RecordedInputs behaviors(KADANS_SOURCE_DIR);
  const HandOvers hand_overs = robot.sets().hand_overs();
  const InputLayout layout = layout_of(robot);
  repeatable.record_inputs({.pieces = std::make_unique<InputPieces>(
                                robot.parts().control, layout,
                                std::vector<const DownStorage*>(hand_overs.down.begin(), hand_overs.down.end())),
                            .behaviors = &behaviors});
  const std::vector<double> row(signals.size(), 0.5);
  std::uint64_t tick = 0;
  const auto cost_ns = [&](Recorder& recorder) {
    constexpr int calls = 100;
    const double began = now_ns();
    for (int j = 0; j < calls; ++j, ++tick) recorder.record(tick, static_cast<std::int64_t>(tick) * 1'000'000, row);
    const double each = (now_ns() - began) / calls;
    (void)recorder.drain();
    return each;
  };
  std::vector<double> without, with;
  for (int i = 0; i < 300; ++i) {
    without.push_back(cost_ns(plain));
    with.push_back(cost_ns(repeatable));
  }
  const double plain_ns = median(without);
  report.add("record_tick_ns", "record() of " + std::to_string(row.size()) + " signals", plain_ns, "ns");
  report.add("record_inputs_ns", "the inputs of a tick beside them, " + std::to_string(layout.words()) + " numbers",
             median(with) - plain_ns, "ns");
  bench_drain(report, signals, false);
  bench_drain(report, signals, true);
}

}  // namespace kadans::bench
