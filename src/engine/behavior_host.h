// The seam between the behavior engine and what plays behaviors. engine does not know Lua; script implements this.
#pragma once

#include "kadans/signal/status.h"
#include "transaction.h"

namespace kadans {

class BehaviorHost {
 public:
  virtual ~BehaviorHost() = default;
  // Behavior thread, once a behavior tick. The snapshot is valid during the call only. Each behavior collects its
  // commands in a transaction of its own from `commands` and commits it.
  virtual void tick(const Snapshot& snapshot, CommandSender& commands) noexcept = 0;
  // Behavior thread, before each tick: orders that are to take effect in it. The snapshot is the tick's, valid during
  // the call only.
  virtual void before_tick(const Snapshot& /*snapshot*/) noexcept {}
  // Behavior thread, shortly before a tick, or never. Fetches what the tick is going to need; changes nothing that a
  // tick could notice. The snapshot is valid during the call only.
  virtual void prepare(const Snapshot& /*newest*/) noexcept {}
};

}  // namespace kadans
