#include "play_list.h"

#include <iterator>

#include "signal/byte_order.h"

namespace kadans {

void PlayStatus::declare(SignalTable& signals) const {
  signals.add({"play.phase", "", "State of the list of behaviors: 0 nothing plays, 1 plays, 2 is paused"}, &phase);
  signals.add({"play.playing", "", "Behaviors of the list that play"}, &playing);
  signals.add({"play.waiting", "", "Behaviors of the list that wait"}, &waiting);
  signals.add({"play.done", "", "Behaviors that ended with the outcome done"}, &done);
  signals.add({"play.not_done", "", "Behaviors that ended with another outcome"}, &not_done);
  signals.add({"play.events", "", "Events from outside or from another behavior that a behavior got"}, &events);
  signals.add({"play.events_refused", "", "Such events that were refused, or that nobody got"}, &events_refused);
}

void PlayList::append(std::vector<Entry>& entries) {
  std::erase_if(entries_, [](const Entry& entry) { return entry.over && !entry.lasting; });
  std::move(entries.begin(), entries.end(), std::back_inserter(entries_));
  entries.clear();
}

bool PlayList::has_turn(std::size_t number) const noexcept {
  const Entry& entry = entries_[number];
  const auto earlier = entries_.begin() + static_cast<std::ptrdiff_t>(number);
  return !entry.over && std::none_of(entries_.begin(), earlier,
                                     [&](const Entry& other) { return other.lane == entry.lane && !other.over; });
}

SetMask PlayList::sets_beside(std::uint32_t lane, const std::vector<Entry>& entries) noexcept {
  SetMask all = 0;
  for (const Entry& entry : entries) {
    if (!entry.over && entry.lane != lane) all |= entry.behavior->control_sets();
  }
  return all;
}

void PlayList::end(Entry& entry) noexcept {
  entry.over = true;
  const bool done = entry.behavior->outcome() == "done";
  (done ? status_.done : status_.not_done).fetch_add(1, std::memory_order_relaxed);
  for (Entry& other : entries_) other.over = other.over || (!done && other.lane == entry.lane);
}

void PlayList::end_all() noexcept {
  for (Entry& entry : entries_) entry.over = true;
}

void PlayList::keep_counts(ByteWriter& bytes) const {
  for (const auto* count : {&status_.done, &status_.not_done, &status_.events, &status_.events_refused})
    bytes.put(count->load(std::memory_order_relaxed));
}

void PlayList::restore_counts(ByteReader& bytes) noexcept {
  for (auto* count : {&status_.done, &status_.not_done, &status_.events, &status_.events_refused})
    count->store(bytes.take<std::uint32_t>(), std::memory_order_relaxed);
}

void PlayList::publish(bool paused) noexcept {
  std::uint32_t left = 0, playing = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    left += entries_[i].over ? 0 : 1;
    playing += has_turn(i) ? 1 : 0;
  }
  status_.playing.store(playing, std::memory_order_relaxed);
  status_.waiting.store(left - playing, std::memory_order_relaxed);
  status_.phase.store(paused ? 2 : left > 0 ? 1 : 0, std::memory_order_relaxed);
}

}  // namespace kadans
