// The memory that the runtime shares with the process in which behaviors are played, one for each such process: who is
// killed in the midst of a push or a write leaves it half done, and nobody else ever looks at it.
//
// The two take turns. The runtime writes a request and rings; the process ticks its behaviors, writes its answer, names
// the request's number in it last of all, and rings. So nothing here is written and read at once as long as both keep
// the rules, and what an unfinished answer holds counts as if it were not there. The runtime does not rely on it: it
// reads nothing from here that it wrote itself, and takes copies of what the process wrote before it looks at them
// (child_answer.h). For this reason the snapshot goes through plain memory and not through Latest, whose writer keeps
// the index of its slot beside the slots.
//
// Trivially copyable, no pointers. Both ends are the same program, so its layout is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kadans/signal/command.h"
#include "kadans/signal/status.h"

namespace kadans {

// What plays and where it is (ScriptHost::keep), with a hash that half of it would not have.
struct KeptState {
  static constexpr std::size_t bytes_max = std::size_t{64} << 10U;
  static constexpr std::uint32_t none = UINT32_MAX;  // as size: it cannot be kept

  std::uint32_t size = 0;
  alignas(8) std::uint64_t hash = 0;
  std::array<std::byte, bytes_max> bytes{};
};
std::uint64_t hash_of_kept(const std::byte* bytes, std::size_t size) noexcept;

struct BehaviorLink {
  static constexpr std::size_t behaviors_max = 32, name_bytes = 64, order_bytes = 8192;
  using Name = std::array<char, name_bytes>;
  using Numbers = std::array<std::uint32_t, 5>;

  // Written by the runtime before the process starts.
  struct Setup {
    std::int32_t priority = 0;  // of SCHED_FIFO; 0: usual
    std::int32_t cpu_to_leave = -1;
    std::uint32_t locks_memory = 0;
    std::uint32_t on_wall_clock = 0;            // ScenarioConfig::on_wall_clock
    alignas(8) std::uint64_t memory_bytes = 0;  // more than it has when it begins to play; 0: no limit
    KeptState kept;                             // of the process before; size 0: there is nothing to go on with
  };
  // Written by the process once, then it rings.
  struct Ready {
    std::uint32_t is = 0;
    alignas(8) std::uint64_t fingerprint = 0;  // of its catalog
    std::uint32_t count = 0;
    std::array<Name, behaviors_max> names{};  // whose status it tells
  };
  struct Request {
    std::uint32_t number = 0;         // from 1
    std::uint32_t last_sequence = 0;  // transactions of the answer are numbered from the next
    std::uint32_t room = 0;           // for commands, headers included
    std::uint32_t order_size = 0;
    std::array<std::byte, order_bytes> order{};
    Snapshot snapshot;
  };
  struct Answer {
    std::uint32_t number = 0;
    Numbers play{};                               // PlayStatus, in its order
    std::array<Numbers, behaviors_max> status{};  // BehaviorStatus, likewise
    std::uint32_t kept_changed = 0;
    KeptState kept;
  };

  Setup setup;
  Ready ready;
  Request request;
  Answer answer;
  CommandQueue commands;                         // of the answer
  Ring<std::byte, std::size_t{1} << 18U> lines;  // what behaviors say: a u32 size, then that many bytes
};
static_assert(std::is_trivially_copyable_v<BehaviorLink>);

// As first byte of a line, beside BehaviorLog's severities.
inline constexpr std::uint8_t transition_line = 16;

}  // namespace kadans
