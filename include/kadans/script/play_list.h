// The behaviors that are played, in lanes: in each lane one after the other, as long as they end with "done"; the lanes
// at the same time, in the list's order within a tick. Behavior thread only, but for the status.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kadans/script/behavior.h"

namespace kadans {

// For the record: relaxed atomics as in BehaviorStatus.
struct PlayStatus {
  std::atomic<std::uint32_t> phase{0};     // 0: nothing plays, 1: something does, 2: paused
  std::atomic<std::uint32_t> playing{0};   // behaviors whose turn it is
  std::atomic<std::uint32_t> waiting{0};   // behaviors whose turn comes
  std::atomic<std::uint32_t> done{0};      // behaviors that ended with "done"
  std::atomic<std::uint32_t> not_done{0};  // behaviors that ended otherwise
  void declare(SignalTable& signals) const;
};

class PlayList {
 public:
  struct Entry {
    std::unique_ptr<Behavior> behavior;
    std::uint32_t lane = 0;
    bool lasting = false;  // stays when it is over: somebody may look at it
    bool over = false;
  };

  // Behind what is there; what is over and not lasting is forgotten.
  void append(std::vector<Entry>& entries);
  // Calls step(entry) for each whose turn it is.
  template <typename Step>
  void each_in_turn(Step step) {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (has_turn(i)) step(entries_[i]);
    }
  }
  // Control sets of the entries that are not over, outside of this lane.
  static SetMask sets_beside(std::uint32_t lane, const std::vector<Entry>& entries) noexcept;
  // `entry` came to its end. Unless it is done, nothing follows in its lane.
  void end(Entry& entry) noexcept;
  void end_all() noexcept;

  void count(std::uint32_t done, std::uint32_t not_done) noexcept;  // those of before

  bool over() const noexcept {
    return std::all_of(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.over; });
  }
  std::vector<Entry>& entries() noexcept { return entries_; }
  const std::vector<Entry>& entries() const noexcept { return entries_; }
  void publish(bool paused) noexcept;
  const PlayStatus& status() const noexcept { return status_; }

 private:
  bool has_turn(std::size_t number) const noexcept;

  std::vector<Entry> entries_;
  PlayStatus status_;
};

}  // namespace kadans
