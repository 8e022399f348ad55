// The events that wait in a behavior, oldest first: sent ones (by m:emit, or from outside), and ends of states. Sent
// ones are bounded in number. A state that ended waits at most once, so ends are never refused. Nothing is allocated
// after the queue was made.
#pragma once

#include <cstddef>
#include <vector>

#include "chart.h"

namespace kadans {

struct WaitingEvent {
  EventId id = no_event;
  StateIndex from = no_state;  // the state that ended; no_state: it was sent
};

class EventQueue {
 public:
  static constexpr std::size_t sent_max = 32;

  explicit EventQueue(std::size_t states) { events_.reserve(sent_max + states); }

  // False: the queue is full.
  bool send(EventId id) noexcept {
    if (sent_ == sent_max) return false;
    ++sent_;
    events_.push_back({.id = id});
    return true;
  }
  void end(StateIndex from, EventId outcome) noexcept {
    withdraw(from);
    events_.push_back({.id = outcome, .from = from});
  }
  // The state goes on, or was left: its end does not count any more.
  void withdraw(StateIndex from) noexcept {
    std::erase_if(events_, [&](const WaitingEvent& event) { return event.from == from; });
  }
  void remove(std::size_t position) noexcept {
    if (events_[position].from == no_state) --sent_;
    events_.erase(events_.begin() + static_cast<std::ptrdiff_t>(position));
  }
  void clear() noexcept { events_.clear(), sent_ = 0; }

  std::size_t size() const noexcept { return events_.size(); }
  const WaitingEvent& operator[](std::size_t position) const noexcept { return events_[position]; }

 private:
  std::vector<WaitingEvent> events_;
  std::size_t sent_ = 0;
};

}  // namespace kadans
