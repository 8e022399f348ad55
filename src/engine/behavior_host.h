// The seam between the behavior engine and what plays behaviors. engine does not know Lua; script implements this.
#pragma once

#include <cstdint>
#include <string>

#include "kadans/signal/status.h"
#include "transaction.h"

namespace kadans {

class BehaviorHost {
 public:
  virtual ~BehaviorHost() = default;
  // Behavior thread, once a behavior tick. The snapshot is valid during the call only. Each behavior collects its
  // commands in a transaction of its own from `commands` and commits it.
  virtual void tick(const Snapshot& snapshot, CommandSender& commands) noexcept = 0;
  // Behavior thread, shortly before a tick, or never. Fetches what the tick is going to need; changes nothing that a
  // tick could notice. The snapshot is valid during the call only.
  virtual void prepare(const Snapshot& /*newest*/) noexcept {}
};

// One change of state of a behavior, for the record and the console.
struct Transition {
  std::int64_t time_ns = 0;
  std::string behavior;
  std::string from;  // path of the state, "stand.wait"; "" when entering
  std::string to;
  std::string why;
};

// Where behaviors report to people. Behavior thread.
class BehaviorLog {
 public:
  virtual ~BehaviorLog() = default;
  enum class Severity : std::uint8_t { info, warning, error };
  virtual void transition(const Transition& transition) = 0;
  virtual void message(std::int64_t time_ns, Severity severity, const std::string& behavior,
                       const std::string& text) = 0;
};

}  // namespace kadans
