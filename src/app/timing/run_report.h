// The report of a run on the wall clock: how punctual its threads were, and what was sent, refused, recorded and lost.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/run/run_threads.h"
#include "engine/tick/tick_statistics.h"
#include "kadans/plant/plant.h"
#include "script/process/process_host.h"
#include "telemetry/record/recorder.h"

namespace kadans {

struct WallClockResult {
  const RunThreads& threads;
  const ControlTask& control;
  const BehaviorEngine& behaviors;
  const ControlEngine& engine;
  const PlantTask* plant = nullptr;  // of a model, else nullptr
  std::vector<PlantCount> link{};    // the link's counts, of a plant that has a link
  const Recorder* recorder = nullptr;
  const ProcessHost* process = nullptr;           // of the behaviors, if they have a process
  const ProcessHost* decision_process = nullptr;  // of the decisions, likewise
  double duration_s = 0;
  double start_ms = 0;  // from the start of the process to the first control tick
  std::string ended;    // why it ended: "told to stop", "duration over", or what failed
  bool failed = false;
};

std::string run_report_text(const WallClockResult& result);
std::string run_report_json(const WallClockResult& result);  // one line

// The durations of ticks for reports: in microseconds, rounded to nanoseconds.
struct TickQuantile {
  const char* name;
  double share;
};
inline constexpr TickQuantile p50{"p50", 0.5}, p90{"p90", 0.9}, p99{"p99", 0.99}, p999{"p999", 0.999},
    p9999{"p9999", 0.9999}, p99999{"p99999", 0.99999};

inline double in_us(double ns) { return std::round(ns) / 1000; }
inline double in_us(std::int64_t ns) { return in_us(static_cast<double>(ns)); }
inline double in_us(const TickStatistics& statistics, const TickQuantile& quantile) {
  return in_us(statistics.percentile_ns(quantile.share));
}

// An object with min, mean, the given quantiles, max.
nlohmann::ordered_json tick_json(const TickStatistics& statistics, std::span<const TickQuantile> quantiles);

// Reports the counts of the link between a plant and its control engine.
std::string link_text(const std::vector<PlantCount>& counts);  // "12 sent, 0 unsent, ..."
nlohmann::ordered_json link_json(const std::vector<PlantCount>& counts);

}  // namespace kadans
