// The names of a chart's events, and the patterns that take several of them. Which events a pattern takes is known for
// each event from the moment when its name is: a step looks at one bit.
#include <algorithm>

#include "chart.h"
#include "script/check/hint.h"

namespace kadans {
namespace {

constexpr std::size_t reported_max = 20;
constexpr std::string_view fault_prefix = "fault.";

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (std::size_t code = 1; code < fault_codes; ++code)
    names.push_back(std::string(fault_prefix) + name(static_cast<FaultCode>(code)));
  return names;
}

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

bool reserved_for_reports(std::string_view event) noexcept {
  return event == "error" || event == "refused" || event.starts_with(fault_prefix);
}

void Chart::find_reports(std::vector<InputProblem>& problems) {
  error_event = find_event("error");
  refused_event = find_event("refused");
  fault_events.clear();
  const std::vector<std::string> names = fault_names();
  for (const std::string& fault : names) {  // known now to what waits for "fault.*"
    if (any_pattern_takes(fault)) intern(fault);
  }
  for (std::size_t code = 0; code < names.size(); ++code) {
    const EventId event = find_event(names[code]);
    if (event != no_event) fault_events.emplace_back(static_cast<FaultCode>(code + 1), event);
  }
  waits_for_reports = refused_event != no_event || !fault_events.empty();
  takes_errors.assign(states.size(), false);
  for (const Transition& transition : transitions) {
    if (transition.on == no_event || problems.size() >= reported_max) continue;
    if (transition.on == error_event) takes_errors[transition.source] = true;
    const std::string& event = events[static_cast<std::size_t>(transition.on)];
    const bool some = std::ranges::any_of(
        fault_events, [&](const auto& fault) { return takes_by_pattern(transition, fault.second); });
    if (!event.starts_with(fault_prefix) || is_report(transition.on) || some) continue;
    problems.push_back({states[transition.source].chunk, transition.line, 0,
                        "the safety layer knows no '" + event + "'" + hint_text(event, names)});
  }
  for (StateIndex i = 1; i < size(); ++i)  // what is around a state comes before it
    takes_errors[i] = takes_errors[i] || takes_errors[states[i].parent];
  for (const State& state : states) {
    if (problems.size() >= reported_max) break;
    if (state.outcome == no_event || !reserved_for_reports(state.outcome_name)) continue;
    problems.push_back({state.chunk, state.line, 0,
                        "final '" + state.name + "' cannot end with '" + state.outcome_name +
                            "': the runner makes that event; give the outcome another name"});
  }
}

}  // namespace kadans
