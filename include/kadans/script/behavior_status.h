// What the behavior thread tells of a behavior to the record: numbers that each stand alone, so that relaxed atomics
// do; the behavior thread stores them after each tick, the control thread reads them when it gathers the signals. In
// lockstep both are one thread and a run repeats: the pause of the collector is wall time and stays 0 there.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "kadans/signal/signal.h"

namespace kadans {

struct BehaviorStatus {
  std::atomic<std::uint32_t> heap_bytes{0};    // of its Lua state
  std::atomic<std::uint32_t> instructions{0};  // of the last tick, in steps of a thousand
  std::atomic<std::uint32_t> gc_pause_ns{0};   // of the collector after the last tick; only where wall time counts
  std::atomic<std::uint32_t> state{0};         // number of the innermost active state in its chart
  std::atomic<std::uint32_t> reloads{0};       // new versions taken

  // Before the loop. Declares behavior.<name>.heap_bytes and so on; the name must be new to the table.
  void declare(SignalTable& signals, const std::string& name) const;
  // The same under the name, or, when that is taken, under the first of name_2, name_3 ... that is free.
  void declare_numbered(SignalTable& signals, const std::string& name) const;
};

}  // namespace kadans
