// The names of a chart's events, and the patterns that take several of them. Which events a pattern takes is known for
// each event from the moment when its name is: a step looks at one bit.
#include <algorithm>

#include "chart.h"
#include "chart_reports.h"

namespace kadans {
namespace {

// SCXML, section 3.12.1: by whole words. "fault.*" takes "fault" and "fault.motor_hot", not "faulty". Ours: "*" takes
// what is sent, but no reports of the runner.
bool pattern_takes(std::string_view pattern, std::string_view event) noexcept {
  if (pattern == "*") return !reserved_for_reports(event);
  const std::string_view words = pattern.substr(0, pattern.size() - 2);
  return event.starts_with(words) && (event.size() == words.size() || event[words.size()] == '.');
}

}  // namespace

EventId Chart::find_event(std::string_view event) const noexcept {
  const auto found = std::find(events.begin(), events.end(), event);
  return found == events.end() ? no_event : static_cast<EventId>(found - events.begin());
}

EventId Chart::intern(std::string_view event) {
  const EventId known = find_event(event);
  if (known != no_event) return known;
  events.emplace_back(event);
  ends_.push_back(false);
  for (Pattern& pattern : patterns)
    pattern.takes.push_back(pattern_takes(events[static_cast<std::size_t>(pattern.event)], event));
  return static_cast<EventId>(events.size() - 1);
}

std::int16_t Chart::intern_pattern(std::string_view text) {
  const EventId event = intern(text);
  ends_[static_cast<std::size_t>(event)] = true;
  const auto known = std::ranges::find(patterns, event, &Pattern::event);
  const auto number = static_cast<std::int16_t>(known - patterns.begin());
  if (known != patterns.end()) return number;
  Pattern& made = patterns.emplace_back();
  made.event = event;
  for (const std::string& one : events) made.takes.push_back(pattern_takes(text, one));
  return number;
}

bool Chart::any_pattern_takes(std::string_view event) const noexcept {
  return std::ranges::any_of(
      patterns, [&](const Pattern& one) { return pattern_takes(events[static_cast<std::size_t>(one.event)], event); });
}

EventId Chart::find_or_learn(std::string_view event) {
  const EventId known = find_event(event);
  const bool learn = late_ < late_events_max && !event.empty() && event.size() <= late_event_length_max &&
                     !is_pattern(event) && any_pattern_takes(event);
  if (known != no_event || !learn) return known;
  ++late_;
  return intern(event);
}

}  // namespace kadans
