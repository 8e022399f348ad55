// The memory that the runtime shares with the process in which behaviors play, or with that of the decisions over them
// (supervisor/decide/decision_process.h), which leaves the commands empty. Each such process gets a new one. When a
// process is killed in the middle of a write, the half-written memory is never read by another process.
//
// The two sides take turns. The runtime writes a request and rings the doorbell. The process ticks its behaviors,
// writes its answer, writes the request's number into it last of all, and rings (exchange/turn.h). As long as both keep
// the rules, nothing is written and read at the same time, and an unfinished answer does not count. The runtime does
// not rely on the rules: it never reads back what it wrote itself, and it copies what the process wrote before it uses
// it (ProcessHost). For this reason the snapshot goes through plain memory and not through Latest, whose writer
// keeps the index of its slot beside the slots.
//
// Trivially copyable, without pointers. Both sides run the same program, so the layout is the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kadans/control/catalog.h"
#include "kadans/exchange/turn.h"
#include "kadans/signal/command.h"
#include "kadans/signal/status.h"
#include "script/behavior/behavior_status.h"
#include "script/host/play_report.h"

namespace kadans {

// The state of the behaviors (ScriptHost::keep), with a hash by which incomplete bytes are detected.
struct KeptState {
  static constexpr std::size_t bytes_max = std::size_t{64} << 10U;
  static constexpr std::uint32_t none = UINT32_MAX;  // as `size`: the state cannot be kept

  std::uint32_t size = 0;
  alignas(8) std::uint64_t hash = 0;
  std::array<std::byte, bytes_max> bytes{};
};
std::uint64_t hash_of_kept(const std::byte* bytes, std::size_t size) noexcept;

struct BehaviorLink {
  static constexpr std::size_t behaviors_max = 32, name_bytes = 64, order_bytes = 8192, question_bytes = 4096;
  static constexpr std::size_t reply_bytes = std::size_t{512} << 10U;  // only pages that are written take memory
  static constexpr std::size_t decided_bytes = std::size_t{64} << 10U, told_bytes = std::size_t{512} << 10U;
  using Name = std::array<char, name_bytes>;
  using Numbers = std::array<std::uint32_t, 5>;
  using PlayNumbers = std::array<std::uint32_t, 7>;
  template <typename T>
  using OfRegions = std::array<std::array<T, BehaviorStatus::regions_max>, behaviors_max>;
  using RegionPath = std::array<char, BehaviorStatus::region_path_max + 1>;

  // Written by the runtime before the process starts.
  struct Setup {
    std::int32_t priority = 0;  // of SCHED_FIFO; 0: normal scheduling
    std::int32_t cpu_to_leave = -1;
    std::uint32_t locks_memory = 0;
    std::uint32_t on_wall_clock = 0;            // ScenarioConfig::on_wall_clock
    std::uint32_t decides = 0;                  // it runs the decisions, and plays no behaviors
    std::uint32_t tells = 0;                    // of decisions: it tells what they take, for a record
    alignas(8) std::uint64_t memory_bytes = 0;  // memory limit beyond what it has when it begins to play; 0: no limit
    KeptState kept;                             // state from the process before; size 0: none
  };
  // Written by the process once; then it rings.
  struct Ready {
    Turn<> is;                                 // 1
    alignas(8) std::uint64_t fingerprint = 0;  // fingerprint of its catalog
    std::uint32_t count = 0;
    std::array<Name, behaviors_max> names{};  // names of the behaviors whose status it reports
    OfRegions<RegionPath> regions{};          // paths of their regions; "": no further one
  };
  // A new value of one of the parameters with which objects foresee (control_object.h). What finds no place comes with
  // the next request.
  struct ParameterValue {
    ParameterId id = 0;
    alignas(8) double value = 0;
  };
  static constexpr std::size_t parameters_max = 256;
  struct Request {
    Turn<> number;                    // counts from 1
    std::uint32_t last_sequence = 0;  // the answer's transactions are numbered from the next number on
    std::uint32_t room = 0;           // for commands, headers included
    std::uint32_t order_size = 0;
    std::array<std::byte, order_bytes> order{};  // one, or several events, each behind its number
    std::uint32_t question_size = 0;
    std::array<std::byte, question_bytes> questions{};  // behavior_tables.h, each behind its number
    std::uint32_t parameter_count = 0;
    std::array<ParameterValue, parameters_max> parameters{};
    PlayReport plays;  // to decisions: what plays now
    Snapshot snapshot;
  };
  struct Answer {
    Turn<> number;                                // number of the request
    PlayNumbers play{};                           // play_numbers()
    std::array<Numbers, behaviors_max> status{};  // behavior_numbers()
    OfRegions<std::uint32_t> regions{};           // the active state of each region
    std::uint32_t kept_changed = 0;
    KeptState kept;
    PlayReport plays;                // of behaviors: what plays now
    std::uint32_t decided_size = 0;  // of decisions: what they ask for
    std::array<std::byte, decided_bytes> decided{};
    std::uint32_t told_size = 0;  // and what they took: BehaviorInputs::tell_on
    std::array<std::byte, told_bytes> told{};
    // To each question, and to each order that was refused, behind its number.
    std::uint32_t reply_size = 0;
    std::array<std::byte, reply_bytes> replies{};
  };

  Setup setup;
  Ready ready;
  Request request;
  Answer answer;
  CommandQueue commands;                         // of the answer
  Ring<std::byte, std::size_t{1} << 18U> lines;  // log lines of the behaviors: a u32 size, then that many bytes
};
static_assert(std::is_trivially_copyable_v<BehaviorLink>);

// Where the numbers of an answer are from, and where they go: pointers to them, in the answer's order.
auto play_numbers(auto& play) {
  return std::array{&play.phase,    &play.playing, &play.waiting,       &play.done,
                    &play.not_done, &play.events,  &play.events_refused};
}
auto behavior_numbers(auto& of) {
  return std::array{&of.heap_bytes, &of.instructions, &of.gc_pause_ns, &of.state, &of.reloads};
}

// A fingerprint by which two processes check that they use the same numbers for parameters, set-points, control sets
// and objects. Each process reads the robot's files itself, and the files may have changed in between. Ranges and poses
// are part of it, values of parameters are not.
std::uint64_t fingerprint_of(const Catalog& catalog);

}  // namespace kadans
