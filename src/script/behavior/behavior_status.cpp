#include "behavior_status.h"

namespace kadans {

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

void BehaviorStatus::declare(SignalTable& signals, const std::string& name) const {
  const std::string prefix = "behavior." + name + ".";
  signals.add({prefix + "heap_bytes", "B", "Memory of the behavior's Lua state."}, &heap_bytes);
  signals.add({prefix + "instructions", "", "Lua instructions of its last tick, in steps of a thousand."},
              &instructions);
  signals.add({prefix + "gc_pause_ns", "ns", "Pause of the collector after its last tick; 0 in virtual time."},
              &gc_pause_ns);
  signals.add({prefix + "state", "", "Number of its innermost active state; 0: the behavior itself."}, &state);
  signals.add({prefix + "reloads", "", "New versions taken since the start."}, &reloads);
}

void BehaviorStatus::declare_numbered(SignalTable& signals, const std::string& name) const {
  std::string free = name;
  for (int number = 2; signals.find("behavior." + free + ".state"); ++number)
    free = name + "_" + std::to_string(number);
  declare(signals, free);
}

}  // namespace kadans
