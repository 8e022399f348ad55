// The events that wait in a behavior, oldest first: sent ones (by m:emit, or from outside), and ends of states. Sent
// ones are bounded in number. A state that ended waits at most once, so ends are never refused. Nothing is allocated
// after the queue was made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "chart.h"

namespace kadans {

struct WaitingEvent {
  EventId id = no_event;
  StateIndex from = no_state;  // the state that ended; no_state: it was sent
  std::int8_t place = -1;      // of its data in the script's memory; -1: it has none
};

class EventQueue {
 public:
  static constexpr std::size_t sent_max = 32;
  static constexpr std::int8_t places = sent_max + 1;  // one more for the event whose step is taken

  explicit EventQueue(std::size_t states) { events_.reserve(sent_max + states); }

  // False: the queue is full, or the place is taken.
  bool send(EventId id, std::int8_t place = -1) noexcept {
    if (sent_ == sent_max || (place >= 0 && (place >= places || taken(place)))) return false;
    ++sent_;
    if (place >= 0) taken_ |= std::uint64_t{1} << place;
    events_.push_back({.id = id, .place = place});
    return true;
  }
  std::int8_t free_place() const noexcept {
    std::int8_t place = 0;
    while (place + 1 < places && taken(place)) ++place;
    return place;
  }
  // The data of an event that was removed is not needed any more.
  void free(const WaitingEvent& event) noexcept {
    if (event.place >= 0) taken_ &= ~(std::uint64_t{1} << event.place);
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
  // Drops what was sent since it had so many.
  void shrink(std::size_t size) noexcept {
    while (events_.size() > size) {
      free(events_.back());
      remove(events_.size() - 1);
    }
  }
  void clear() noexcept { events_.clear(), sent_ = 0, taken_ = 0; }

  std::size_t size() const noexcept { return events_.size(); }
  const WaitingEvent& operator[](std::size_t position) const noexcept { return events_[position]; }

 private:
  bool taken(std::int8_t place) const noexcept { return ((taken_ >> place) & 1U) != 0; }

  std::vector<WaitingEvent> events_;
  std::uint64_t taken_ = 0;  // places
  std::size_t sent_ = 0;
};

}  // namespace kadans
