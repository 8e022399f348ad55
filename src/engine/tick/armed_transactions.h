// Transactions that wait in the control engine until a condition is true. A behavior, which runs a hundred times a
// second, prepares what to do; the control thread looks at the conditions in each tick, behind the commands that
// arrived in it, and carries the commands out in the tick in which they become true. So from a contact to the torque it
// takes as many ticks as from a command to the torque.
//
// A transaction is carried out once, or each time that its conditions become true, until it is taken back or has waited
// for the time that it was given. At most max_armed wait. The emergency stop takes all of them back. Conditions are
// about signals as they are in this tick, about time, and about the end of motions. A signal that is not finite is
// neither above nor below a number.
//
// Control thread only. Nothing here allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/motion/setpoint_motions.h"
#include "kadans/control/catalog.h"
#include "kadans/signal/command.h"
#include "kadans/signal/status.h"

namespace kadans {

class ArmedTransactions {
 public:
  ArmedTransactions(const Catalog& catalog, const SetpointMotions& motions) noexcept
      : catalog_(catalog), motions_(motions) {}

  // Whether one more can wait, beside those that wait and `others` of the same transaction.
  bool has_room(std::uint32_t others) const noexcept;
  // Whether the command is a condition that can be evaluated.
  RefusalReason judge(const Command& condition) const noexcept;
  // Whether a command may wait behind an arm.
  static bool can_wait(CommandKind kind) noexcept;

  // `at(i)` is the i-th command behind the arm; all were judged.
  template <typename At>
  void arm(const Command& arm, std::uint32_t sequence, std::uint16_t which, std::int64_t time_ns, At at) noexcept {
    Slot& slot = begin(arm, sequence, which, time_ns);
    for (std::uint32_t i = 0; i < arm.count; ++i) add(slot, at(i));
  }
  void disarm(std::uint32_t sequence, std::uint32_t which) noexcept;
  void disarm_all() noexcept;

  // Calls carry_out(sequence, commands) for each whose conditions became true; it returns why not, or none.
  template <typename CarryOut>
  void step(std::uint64_t tick, std::int64_t time_ns, CarryOut carry_out) noexcept {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (status_[i].state != ArmedState::waits || !due(i, time_ns)) continue;
      Slot& slot = slots_[i];
      note(i, tick, carry_out(status_[i].sequence, std::span<const Command>(slot.commands.data(), slot.command_count)));
    }
  }
  std::uint32_t waiting() const noexcept;
  // Between ticks: all that changes from tick to tick (kadans/control/state_bytes.h), of those that wait.
  void pass_state(StateBytes& bytes) noexcept;
  void fill(Snapshot& snapshot) const noexcept { snapshot.armed = status_; }

 private:
  struct Slot {
    std::array<Command, max_armed_conditions> conditions;
    std::array<Command, max_armed_commands> commands;
    std::uint32_t condition_count = 0, command_count = 0, expected_conditions = 0;
    std::uint32_t options = 0;
    std::int64_t armed_ns = 0, expires_ns = 0;
    std::uint64_t ended = 0;  // a number that grows with each that ends
    bool was_true = false;    // its conditions, in the tick before
  };
  Slot& begin(const Command& arm, std::uint32_t sequence, std::uint16_t which, std::int64_t time_ns) noexcept;
  void add(Slot& slot, const Command& command) const noexcept;
  bool due(std::size_t index, std::int64_t time_ns) noexcept;
  void note(std::size_t index, std::uint64_t tick, RefusalReason refused) noexcept;
  void end(std::size_t index, ArmedState how) noexcept;
  bool holds(const Command& condition, double waited_s) const noexcept;

  const Catalog& catalog_;
  const SetpointMotions& motions_;
  std::array<Slot, max_armed> slots_{};
  std::array<ArmedStatus, max_armed> status_{};
  std::uint64_t ended_ = 0;
};

}  // namespace kadans
