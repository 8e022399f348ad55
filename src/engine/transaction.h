// How commands reach the control engine: collected in a transaction, sent whole or not at all.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "behavior_inputs.h"
#include "kadans/signal/command.h"

namespace kadans {

// One producer's end of the command queue. Behavior thread only.
class CommandSender {
 public:
  explicit CommandSender(CommandQueue& queue) noexcept : queue_(queue) {}

  void begin(std::int64_t time_ns) noexcept;  // of the behavior tick; drops what was added and not committed
  // False when the transaction would not fit into the queue or into one tick; the whole transaction is then refused
  // by commit().
  [[nodiscard]] bool add(const Command& command) noexcept;
  // What was added behind a mark can be taken back, until commit().
  struct Mark {
    std::size_t size = 1;
    std::uint64_t overflow = 0;
    bool switches = false;
  };
  Mark mark() const noexcept { return {size_, overflow_, switches_}; }
  void take_back_to(const Mark& mark) noexcept {
    size_ = mark.size;
    overflow_ = mark.overflow;
    switches_ = mark.switches;
  }
  // The number of the transaction, from 1; 0 when it was refused; the last number again when nothing was added.
  std::uint32_t commit() noexcept;
  void discard() noexcept;
  // For a sender in another process, whose queue is emptied into the engine's queue. The next transaction gets the
  // number last_sequence + 1, and until the next call at most `room` commands are sent, headers included.
  void follow(std::uint32_t last_sequence, std::size_t room) noexcept;
  // Whoever records what is sent; nullptr: nobody. in_tick: what is sent from now on comes from a behavior.
  void tell(BehaviorInputs* inputs) noexcept { told_ = inputs; }
  void in_tick(bool yes) noexcept { in_tick_ = yes; }
  std::size_t room() const noexcept { return std::min(room_, queue_.free()); }  // commands, headers included
  // What the last commit() sent; empty when it sent nothing. Valid until the next add().
  std::span<const Command> committed() const noexcept { return {batch_.data() + 1, committed_}; }

  std::uint32_t last_sequence() const noexcept { return sequence_; }
  std::uint32_t last_switch() const noexcept { return switch_; }  // the last one that switches control sets; 0: none
  std::uint64_t sent() const noexcept { return sent_; }           // commands, headers not counted
  std::uint64_t refused() const noexcept { return refused_; }     // commands in refused transactions

 private:
  CommandQueue& queue_;
  std::array<Command, max_transaction> batch_{};
  std::size_t size_ = 1;  // batch_[0] is the header
  std::size_t committed_ = 0;
  std::int64_t time_ns_ = 0;
  std::uint32_t sequence_ = 0, switch_ = 0;
  bool switches_ = false;  // what was added since begin()
  std::size_t room_ = SIZE_MAX;
  std::uint64_t sent_ = 0, refused_ = 0;
  std::uint64_t overflow_ = 0;  // commands that did not fit
  BehaviorInputs* told_ = nullptr;
  bool in_tick_ = false;
};

}  // namespace kadans
