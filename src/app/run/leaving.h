// Prepares a robot for being switched off: the playing behaviors leave their states, then the robot moves to the safe
// posture of its configuration. It runs on the behavior thread after the supervisor has called ask().
#pragma once

#include <atomic>
#include <cstdint>

#include "config/scenario/play_item.h"
#include "engine/behavior_engine.h"
#include "realtime/engine_tasks.h"
#include "script/host/safe_posture.h"

namespace kadans {

class Leaving final : public BesideTick {
 public:
  // Throws InputError on an unknown pose.
  Leaving(const SafePosture::Settings& posture, const Catalog& catalog, OrderTaker& host, BehaviorEngine& behaviors,
          EngineExchange& exchange)
      : posture_({.pose = posture.pose, .after_s = 0, .time_s = posture.time_s}, catalog),
        host_(host),
        behaviors_(behaviors),
        exchange_(exchange) {}

  void ask() noexcept { asked_.store(true, std::memory_order_relaxed); }  // supervisor
  void beside_tick(std::int64_t time_ns) override;

 private:
  enum class Step : std::uint8_t { play, leave, move };

  SafePosture posture_;
  OrderTaker& host_;
  BehaviorEngine& behaviors_;
  EngineExchange& exchange_;
  std::atomic<bool> asked_{false};
  Step step_ = Step::play;
};

}  // namespace kadans
