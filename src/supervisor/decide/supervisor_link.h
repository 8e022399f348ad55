// The storages between the behavior thread and the supervisor. Neither side ever waits for the other.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "config/scenario/play_item.h"
#include "decision_questions.h"
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

class SupervisorLink {
 public:
  SupervisorLink() = default;
  ~SupervisorLink() {
    for (PlayOrder* order = nullptr; orders_.try_pop(order);) delete order;
  }
  SupervisorLink(const SupervisorLink&) = delete;
  SupervisorLink& operator=(const SupervisorLink&) = delete;

  std::atomic<bool> leaving{false};  // written by any thread: the run ends, and nothing is decided any more
  DecisionQuestions questions;       // of people, both ways

  // Written by the behavior thread, read by the supervisor.
  Latest<Snapshot> snapshot;
  Latest<PlayReport> report;
  Ring<PastPose, 256> poses;  // of each behavior tick; what does not fit is missing in the odometry's past

  // Written by the supervisor, read by the behavior thread.
  Latest<Heartbeat> heartbeat;
  EventLog lines;  // what it says on a thread of its own; the behavior thread says it on
  // False: the ring is full, and the order is lost. The order is freed by the behavior thread.
  [[nodiscard]] bool give(PlayOrder order) {
    auto owned = std::make_unique<PlayOrder>(std::move(order));
    if (!orders_.try_push(owned.get())) return false;
    (void)owned.release();
    return true;
  }
  std::unique_ptr<PlayOrder> take() noexcept {
    PlayOrder* order = nullptr;
    (void)orders_.try_pop(order);
    return std::unique_ptr<PlayOrder>(order);
  }

 private:
  Ring<PlayOrder*, 64> orders_;
};

}  // namespace kadans
