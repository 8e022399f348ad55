#include "event_delivery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "behavior_tables.h"
#include "config/json/problems.h"
#include "config/scenario/event_text.h"
#include "signal/byte_order.h"
#include "signal/utf8.h"

namespace kadans {

using Severity = BehaviorLog::Severity;

namespace {

// A line tells the beginning; the record has all of the data in /events.
std::string shortened(std::string text) {
  constexpr std::size_t told = 200;
  if (text.size() <= told) return text;
  std::size_t end = told;
  while (end > 0 && inside_character(text[end])) --end;
  return text.substr(0, end) + "...";
}

bool is_meant(const std::string& to, const Behavior& behavior) {
  return to.empty() || to == "all" || to == behavior.name();
}

}  // namespace

EventDelivery::EventDelivery(BehaviorLog& log, std::vector<InputEvent> inputs, PlayList& list, const Pause& pause)
    : log_(log), list_(list), pause_(pause), inputs_(std::move(inputs)), levels_(inputs_.size(), Level::unknown) {}

std::string EventDelivery::refusal(const PlayedEvent& event, const std::string& to) {
  if (pause_.paused()) return "the behaviors are paused; the event would be old when they go on";
  std::vector<std::string> known;
  std::string wrong, waits;
  bool fits = false;
  list_.each_in_turn([&](const PlayList::Entry& entry) {
    const Behavior& behavior = *entry.behavior;
    if (!is_meant(to, behavior)) return;
    for (const ScriptEvent& declared : behavior.events()) known.push_back(declared.name);
    if (const ScriptEvent* declared = find_event(behavior.events(), event.name)) {
      const std::string why = wrong_data(*declared, event).why;
      fits = fits || why.empty();
      if (wrong.empty()) wrong = why;
    } else if (const EventId id = behavior.chart().find_event(event.name);
               id != no_event && !behavior.chart().made_by_runner(id)) {
      waits = behavior.name();
    }
  });
  if (fits || !wrong.empty()) return fits ? "" : wrong;
  if (!waits.empty())
    return "'" + waits + "' does not let the event '" + event.name + "' in: it lacks k.events { " + event.name +
           " = {} }";
  if (known.empty() && !to.empty() && to != "all") return "no '" + to + "' that declares events (k.events) plays";
  if (known.empty()) return "no behavior that plays declares events (k.events)";
  std::ranges::sort(known);
  known.erase(std::unique(known.begin(), known.end()), known.end());
  return unknown_name("event", event.name, known, "for what plays");
}

void EventDelivery::refuse(const PlayedEvent& event, const std::string& why, const Snapshot& snapshot) {
  list_.count_event(false);
  tell(event, Severity::warning, in_quotes(event.name) + " from " + event.who + " was refused: " + why, snapshot);
}

// Lines about inputs are bounded: a switch that bounces sends events for ever.
void EventDelivery::tell(const PlayedEvent& event, Severity severity, const std::string& text,
                         const Snapshot& snapshot) {
  if (event.of_input) {
    const LogBound::Answer answer = input_lines_.admit(snapshot.time_ns);
    if (answer == LogBound::Answer::drop) return;
    if (answer == LogBound::Answer::warn)
      return log_.message(snapshot.time_ns, Severity::warning, "supervisor",
                          "event lines of inputs: more than " + std::to_string(LogBound::lines_max) +
                              " in this second, the others are not told");
  }
  log_.message(snapshot.time_ns, severity, "supervisor", "event " + text);
}

void EventDelivery::deliver(const PlayedEvent& event, const std::string& to, const Snapshot& snapshot) {
  if (const std::string why = refusal(event, to); !why.empty()) return refuse(event, why, snapshot);
  std::string takers, wrong, data = data_json(event.data);
  if (data_bytes_ + data.size() > data_bytes_max)
    return refuse(event,
                  "the events of this tick bring more than " + std::to_string(data_bytes_max >> 10U) + " kB of data",
                  snapshot);
  data_bytes_ += data.size();
  list_.each_in_turn([&](const PlayList::Entry& entry) {
    if (!is_meant(to, *entry.behavior) || find_event(entry.behavior->events(), event.name) == nullptr) return;
    const std::string why = entry.behavior->post(event);
    if (why.empty()) takers += (takers.empty() ? "" : ", ") + entry.behavior->name();
    if (!why.empty()) wrong = why;
  });
  if (!wrong.empty()) refuse(event, wrong, snapshot);
  if (takers.empty()) return;
  list_.count_event(true);
  log_.emitted({.time_ns = snapshot.time_ns,
                .tick = snapshot.tick,
                .event = event.name,
                .data = std::move(data),
                .who = event.who,
                .ordered = event.ordered});
  tell(event, Severity::info, shortened(event_text(event)) + " from " + event.who + " to " + takers, snapshot);
}

EventDelivery::Level EventDelivery::level_of(const InputEvent& input, const Snapshot& snapshot) noexcept {
  if (input.of == InputEvent::Of::button)
    return snapshot.joystick.buttons[input.index % joystick_buttons] ? Level::on : Level::off;
  const double value = snapshot.status.channels[input.index % max_channels];
  if (input.index >= snapshot.status.channel_count || std::isnan(value)) return Level::unknown;
  return value > 0.5 ? Level::on : Level::off;
}

void EventDelivery::look_at_inputs(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Level level = level_of(inputs_[i], snapshot);
    if (level == Level::unknown) continue;
    const Level before = std::exchange(levels_[i], level);
    if (before == Level::unknown || before == level) continue;
    input_says(inputs_[i], level == Level::on ? inputs_[i].rise : inputs_[i].fall, snapshot);
  }
}

// A configuration names events for several behaviors, so that nobody declares one is told once.
void EventDelivery::input_says(const InputEvent& input, const std::string& event, const Snapshot& snapshot) {
  if (event.empty()) return;
  const PlayedEvent played{.name = event, .who = input.input, .of_input = true};
  bool declared = false;
  list_.each_in_turn([&](const PlayList::Entry& entry) {
    declared = declared || find_event(entry.behavior->events(), event) != nullptr;
  });
  if (declared) return deliver(played, "", snapshot);
  list_.count_event(false);
  if (!told("input " + input.input + " " + event))
    log_.message(snapshot.time_ns, Severity::info, "supervisor",
                 "event '" + event + "' from " + input.input + ": no behavior that plays declares it (told once)");
}

void EventDelivery::collect(PlayList::Entry& sender) {
  for (SentEvent& sent : sender.behavior->sent_events()) {
    sent.event.who = sender.behavior->name();
    sent.lane = sender.lane;
    sent_.push_back(std::move(sent));
  }
  sender.behavior->sent_events().clear();
}

void EventDelivery::deliver_sent(const Snapshot& snapshot) {
  for (const SentEvent& sent : std::exchange(sent_, {})) {
    bool taken = false;
    std::string wrong = "nobody of that name plays and declares it";
    if (sent.to == "all") wrong = "no other behavior that plays declares it";
    list_.each_in_turn([&](const PlayList::Entry& entry) {
      Behavior& behavior = *entry.behavior;
      const bool itself = entry.lane == sent.lane && behavior.name() == sent.event.who;
      if (itself || (sent.to != "all" && sent.to != behavior.name())) return;
      if (find_event(behavior.events(), sent.event.name) == nullptr) return;
      const std::string why = behavior.post(sent.event);
      taken = taken || why.empty();
      if (!why.empty()) wrong = why;
    });
    list_.count_event(taken);
    if (!taken && !told("sent " + sent.event.who + " " + sent.event.name + " " + sent.to))
      log_.message(snapshot.time_ns, Severity::warning, sent.event.who,
                   "event '" + sent.event.name + "' to '" + sent.to + "' was refused: " + wrong + " (told once)");
  }
}

void EventDelivery::keep(ByteWriter& bytes) const {
  bytes.put(static_cast<std::uint32_t>(levels_.size()));
  for (const Level level : levels_) bytes.put(static_cast<std::uint8_t>(level));
  bytes.put(static_cast<std::uint32_t>(sent_.size()));
  for (const SentEvent& sent : sent_) {
    put_event(sent.event, bytes);
    bytes.put_string(sent.to);
    bytes.put(sent.lane);
  }
}

void EventDelivery::restore(ByteReader& bytes) {
  const auto inputs = bytes.take<std::uint32_t>();
  for (std::uint32_t i = 0; i < inputs && bytes.ok(); ++i) {
    const auto level = bytes.take<std::uint8_t>();
    if (i < levels_.size() && level <= static_cast<std::uint8_t>(Level::on)) levels_[i] = static_cast<Level>(level);
  }
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    SentEvent sent{.event = take_event(bytes), .to = bytes.take_string()};
    sent.lane = bytes.take<std::uint32_t>();
    if (bytes.ok()) sent_.push_back(std::move(sent));
  }
}

}  // namespace kadans
