// The status of a behavior for the record. The behavior thread stores the numbers after each tick, and the control
// thread reads them when it gathers the signals. Each number stands alone, so relaxed atomics suffice. In lockstep both
// threads are one and a run repeats bit for bit; so the collector's pause, which is wall time, stays 0 there.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/signal.h"

namespace kadans {

struct BehaviorStatus {
  std::atomic<std::uint32_t> heap_bytes{0};    // used by its Lua state
  std::atomic<std::uint32_t> instructions{0};  // of the last tick, in steps of a thousand
  std::atomic<std::uint32_t> gc_pause_ns{0};   // of the collector after the last tick; 0 on virtual time
  std::atomic<std::uint32_t> state{0};         // number of the innermost active state in its first chart
  std::atomic<std::uint32_t> reloads{0};       // number of new versions taken

  // The same as `state` for each region, in the order of region_paths; 0: it is not active. With `state` they are all
  // innermost active states: a state is active when the number of the region that it is in is its own or lies in it.
  static constexpr std::size_t regions_max = 32, region_path_max = 127;
  std::array<std::atomic<std::uint32_t>, regions_max> regions{};
  std::vector<std::string> region_paths{};  // set before declare()

  static bool is_region_path(std::string_view path) noexcept;  // small enough, and parts between single dots

  // Before the loop. Declares behavior.<name>.heap_bytes and so on, behavior.<name>.region.<path>. A name that is taken
  // is replaced by the first free one of name_2, name_3 ... Returns the name.
  std::string declare_numbered(SignalTable& signals, const std::string& name) const;
};

}  // namespace kadans
