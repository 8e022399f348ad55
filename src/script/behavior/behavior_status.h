// The status of a behavior for the record. The behavior thread stores the numbers after each tick, and the control
// thread reads them when it gathers the signals. Each number stands alone, so relaxed atomics suffice. In lockstep both
// threads are one and a run repeats bit for bit; so the collector's pause, which is wall time, stays 0 there.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "kadans/signal/signal.h"

namespace kadans {

struct BehaviorStatus {
  std::atomic<std::uint32_t> heap_bytes{0};    // used by its Lua state
  std::atomic<std::uint32_t> instructions{0};  // of the last tick, in steps of a thousand
  std::atomic<std::uint32_t> gc_pause_ns{0};   // of the collector after the last tick; 0 on virtual time
  std::atomic<std::uint32_t> state{0};         // number of the innermost active state in its chart
  std::atomic<std::uint32_t> reloads{0};       // number of new versions taken

  // Before the loop. Declares behavior.<name>.heap_bytes and so on. The name must not be in the table yet.
  void declare(SignalTable& signals, const std::string& name) const;
  // The same, but a name that is taken is replaced by the first free one of name_2, name_3 ...
  void declare_numbered(SignalTable& signals, const std::string& name) const;
};

}  // namespace kadans
