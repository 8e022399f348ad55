#include "chart_reports.h"

#include <algorithm>
#include <string>

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

}  // namespace

bool reserved_for_reports(std::string_view event) noexcept {
  return event == "error" || event == "refused" || event.starts_with(fault_prefix);
}

void find_reports(Chart& chart, std::vector<InputProblem>& problems) {
  chart.error_event = chart.find_event("error");
  chart.refused_event = chart.find_event("refused");
  chart.fault_events.clear();
  const std::vector<std::string> names = fault_names();
  for (const std::string& fault : names) {  // known now to what waits for "fault.*"
    if (chart.any_pattern_takes(fault)) chart.intern(fault);
  }
  for (std::size_t code = 0; code < names.size(); ++code) {
    const EventId event = chart.find_event(names[code]);
    if (event != no_event) chart.fault_events.emplace_back(static_cast<FaultCode>(code + 1), event);
  }
  chart.waits_for_reports = chart.refused_event != no_event || !chart.fault_events.empty();
  chart.takes_errors.assign(chart.states.size(), false);
  for (const Chart::Transition& transition : chart.transitions) {
    if (transition.on == no_event || problems.size() >= reported_max) continue;
    if (transition.on == chart.error_event) chart.takes_errors[transition.source] = true;
    const std::string& event = chart.events[static_cast<std::size_t>(transition.on)];
    const bool some = std::ranges::any_of(
        chart.fault_events, [&](const auto& fault) { return chart.takes_by_pattern(transition, fault.second); });
    if (!event.starts_with(fault_prefix) || chart.is_report(transition.on) || some) continue;
    problems.push_back({chart.states[transition.source].chunk, transition.line, 0,
                        "the safety layer knows no '" + event + "'" + hint_text(event, names)});
  }
  for (StateIndex i = 1; i < chart.size(); ++i)  // what is around a state comes before it
    chart.takes_errors[i] = chart.takes_errors[i] || chart.takes_errors[chart.states[i].parent];
  for (const Chart::State& state : chart.states) {
    if (problems.size() >= reported_max) break;
    if (state.outcome == no_event || !reserved_for_reports(state.outcome_name)) continue;
    problems.push_back({state.chunk, state.line, 0,
                        "final '" + state.name + "' cannot end with '" + state.outcome_name +
                            "': the runner makes that event; give the outcome another name"});
  }
}

}  // namespace kadans
