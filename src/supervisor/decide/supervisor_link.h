// The storages between the behavior thread and the supervisor. Neither side ever waits for the other.
#pragma once

#include <atomic>
#include <cstdint>

#include "config/scenario/play_item.h"
#include "decision_questions.h"
#include "exchange/owned_ring.h"
#include "kadans/exchange/latest.h"
#include "kadans/exchange/ring.h"
#include "kadans/signal/status.h"
#include "kadans/supervisor/odometry_past.h"
#include "script/host/play_report.h"
#include "telemetry/record/event_log.h"

namespace kadans {

struct Heartbeat {
  std::uint32_t ticks = 0;   // so far; wraps around
  std::uint32_t failed = 0;  // 1: nothing decides any more, because of an error
};

struct SupervisorLink {
  std::atomic<bool> leaving{false};  // written by any thread: the run ends, and nothing is decided any more
  DecisionQuestions questions;       // of people, both ways

  // Written by the behavior thread, read by the supervisor.
  Latest<Snapshot> snapshot;
  Latest<PlayReport> report;
  Ring<PastPose, 256> poses;  // of each behavior tick; what does not fit is missing in the odometry's past

  // Written by the supervisor, read by the behavior thread.
  Latest<Heartbeat> heartbeat;
  EventLog lines;                   // what it says on a thread of its own; the behavior thread says it on
  OwnedRing<PlayOrder, 64> orders;  // one that finds no room is lost
};

}  // namespace kadans
