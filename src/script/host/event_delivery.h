// Brings events to behaviors: from outside (orders, scenarios, inputs of the robot) and from one behavior to others. It
// is the only way in. An event goes to each behavior that plays, declares it (k.events) and whose declaration its data
// fits. Whatever is refused is counted and told.
//
// In a tick come first what behaviors sent in the tick before, in the order of the list and of their calls; then what
// inputs say, in the order of the configuration; then what is due by time, then orders, each in their order. In a pause
// an event from outside is refused, because it would be old when the charts go on. What behaviors sent in the tick
// before waits in their queues.
//
// Behavior thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "config/robot/input_event.h"
#include "engine/behavior_log.h"
#include "kadans/signal/status.h"
#include "pause.h"
#include "play_list.h"
#include "script/chart/event_queue.h"

namespace kadans {

class EventDelivery {
 public:
  static constexpr std::size_t ordered_max = EventQueue::sent_max;  // by orders, for one tick

  // Of the data of events from outside in one tick, as JSON: the record has all of it, and its ring has room for more.
  static constexpr std::size_t data_bytes_max = std::size_t{64} << 10U;

  // The references must outlive it.
  EventDelivery(BehaviorLog& log, std::vector<InputEvent> inputs, PlayList& list, const Pause& pause);

  // To be called when a tick begins.
  void begin_tick() noexcept { data_bytes_ = 0; }
  // Why nobody could take the event now; "": somebody can. `to`: the name of a behavior; "" or "all": all of them.
  std::string refusal(const PlayedEvent& event, const std::string& to);
  void deliver(const PlayedEvent& event, const std::string& to, const Snapshot& snapshot);
  // To be called in each tick: what inputs say, as compared with the tick before.
  void look_at_inputs(const Snapshot& snapshot);
  // To be called after the tick of a behavior.
  void collect(PlayList::Entry& sender);
  void deliver_sent(const Snapshot& snapshot);

  // For another process.
  void keep(ByteWriter& bytes) const;
  void restore(ByteReader& bytes);

 private:
  enum class Level : std::uint8_t { unknown, off, on };
  static Level level_of(const InputEvent& input, const Snapshot& snapshot) noexcept;
  void input_says(const InputEvent& input, const std::string& event, const Snapshot& snapshot);
  void refuse(const PlayedEvent& event, const std::string& why, const Snapshot& snapshot);
  void tell(const PlayedEvent& event, BehaviorLog::Severity severity, const std::string& text,
            const Snapshot& snapshot);
  bool told(const std::string& what) { return told_.size() >= told_max || !told_.insert(what).second; }

  static constexpr std::size_t told_max = 256;
  BehaviorLog& log_;
  PlayList& list_;
  const Pause& pause_;
  std::vector<InputEvent> inputs_;
  std::vector<Level> levels_;  // of the inputs
  std::vector<SentEvent> sent_;
  std::size_t data_bytes_ = 0;  // of this tick
  std::set<std::string> told_;  // what is told only once
  LogBound input_lines_;
};

}  // namespace kadans
