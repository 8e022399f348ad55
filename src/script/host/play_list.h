// The list of behaviors that play, in lanes. In a lane they play one after the other, as long as each ends with "done".
// The lanes play at the same time; within a tick they step in the list's order. Behavior thread only, except for the
// status.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "script/behavior/behavior.h"

namespace kadans {

// The status for the record: relaxed atomics as in BehaviorStatus.
struct PlayStatus {
  std::atomic<std::uint32_t> phase{0};                      // 0: nothing plays, 1: something plays, 2: paused
  std::atomic<std::uint32_t> playing{0};                    // behaviors whose turn it is
  std::atomic<std::uint32_t> waiting{0};                    // behaviors whose turn comes later
  std::atomic<std::uint32_t> done{0};                       // behaviors that ended with "done"
  std::atomic<std::uint32_t> not_done{0};                   // behaviors that ended otherwise
  std::atomic<std::uint32_t> events{0}, events_refused{0};  // from outside, and between behaviors
  void declare(SignalTable& signals) const;
};

class PlayList {
 public:
  struct Entry {
    std::unique_ptr<Behavior> behavior;
    std::uint32_t lane = 0;
    bool lasting = false;  // stays in the list when it is over, so that it can be inspected
    bool over = false;
  };

  // Appends entries. Earlier entries that are over and not lasting are removed.
  void append(std::vector<Entry>& entries);
  // Calls step(entry) for each entry whose turn it is.
  template <typename Step>
  void each_in_turn(Step step) {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (has_turn(i)) step(entries_[i]);
    }
  }
  // The control sets of the entries in other lanes that are not over.
  static SetMask sets_beside(std::uint32_t lane, const std::vector<Entry>& entries) noexcept;
  // To be called when `entry` has ended. Unless it ended with "done", its lane is over, too.
  void end(Entry& entry) noexcept;
  void end_all() noexcept;

  void count_event(bool taken) noexcept {
    (taken ? status_.events : status_.events_refused).fetch_add(1, std::memory_order_relaxed);
  }
  // For another process: what has ended so far, and the events.
  void keep_counts(ByteWriter& bytes) const;
  void restore_counts(ByteReader& bytes) noexcept;

  bool over() const noexcept {
    return std::all_of(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.over; });
  }
  bool has_turn(std::size_t number) const noexcept;  // it plays now
  std::vector<Entry>& entries() noexcept { return entries_; }
  const std::vector<Entry>& entries() const noexcept { return entries_; }
  void publish(bool paused) noexcept;
  const PlayStatus& status() const noexcept { return status_; }

 private:
  std::vector<Entry> entries_;
  PlayStatus status_;
};

}  // namespace kadans
