// The report of a live run: how punctual its threads were, and what was sent, refused, recorded and lost.
#pragma once

#include <cstdint>
#include <string>

#include "app/run/live_threads.h"
#include "kadans/plant/plant.h"
#include "script/process/process_host.h"
#include "telemetry/record/recorder.h"

namespace kadans {

struct LiveResult {
  const LiveThreads& threads;
  const ControlTask& control;
  const BehaviorEngine& behaviors;
  const ControlEngine& engine;
  const PlantTask* plant = nullptr;  // of a model, else nullptr
  std::vector<PlantCount> link{};    // the link's counts, of a plant that has a link
  const Recorder* recorder = nullptr;
  const ProcessHost* process = nullptr;  // of the behaviors, if they have a process
  double duration_s = 0;
  double start_ms = 0;  // from the start of the process to the first control tick
  std::string ended;    // why it ended: "told to stop", "duration over", or what failed
  bool failed = false;
};

std::string live_text(const LiveResult& result);
std::string live_json(const LiveResult& result);  // one line

}  // namespace kadans
