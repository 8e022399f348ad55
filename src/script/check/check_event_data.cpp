// Guards and actions that read what an event brings: s.event.data.distance_m. A transition without `on`, or on the end
// of a run, sees no event: there s.event.data is nil. A field that k.events declares as optional is nil when its sender
// left it out. Only what raises for sure is told: a function that looks at s.event in some other way may know better.
#include <algorithm>
#include <map>
#include <vector>

#include "check_source.h"

namespace kadans {
namespace {

// A guard or an action, and all transitions that have it.
struct EventReader {
  ChartFunction function;
  bool guard = false;
  std::vector<const Chart::Transition*> transitions;
};

class EventDataCheck {
 public:
  EventDataCheck(const Behavior::Parts& parts, const ChartFunctions& functions, std::vector<InputProblem>& problems)
      : chart_(parts.chart), events_(parts.lua->core().events), functions_(functions), problems_(problems) {}

  void look(const EventReader& reader) {
    const auto& [tokens, function] = functions_.begin_of(reader.function);
    if (function == 0) return;
    const std::string snapshot = argument(tokens, function, reader.guard ? 0 : 1);
    if (snapshot.empty()) return;
    std::vector<std::size_t> reads;  // of `s` in s.event.data.field
    const std::size_t end = end_of_block(tokens, function);
    for (std::size_t i = function; i < end; ++i) {
      if (!tokens[i].is_name(snapshot) || !tokens[i + 1].is(".") || !tokens[i + 2].is_name("event")) continue;
      const bool of_data = tokens[i + 3].is(".") && tokens[i + 4].is_name("data") && tokens[i + 5].is(".");
      if (!of_data) return;  // it asks for the event's name, whether there are data, or hands them on
      reads.push_back(i);
    }
    if (reads.empty()) return;
    const auto blind = [](const Chart::Transition* one) { return one->on == no_event || one->on == run_done_event; };
    if (std::ranges::all_of(reader.transitions, blind)) {
      const bool run = reader.transitions.front()->on == run_done_event;
      problems_.push_back(
          {reader.function.chunk, tokens[reads.front()].line, 0,
           snapshot + ".event.data is nil here: " +
               (run ? "the end of a run brings no data" : "only a transition with `on` sees an event")});
      return;
    }
    for (const std::size_t at : reads) optional(reader, tokens, reads, at);
  }

 private:
  // The name of a function's argument.
  static std::string argument(const Tokens& tokens, std::size_t function, std::size_t number) {
    const std::size_t at = function + 2 + 2 * number;
    const bool there =
        tokens[function + 1].is("(") && tokens[at].kind == TokenKind::name && (number == 0 || tokens[at - 1].is(","));
    return there ? tokens[at].text : "";
  }

  bool may_be_missing(const Chart::Transition& transition, const std::string& field) const {
    if (transition.on == no_event || transition.pattern >= 0) return false;
    const auto named = [&](const ScriptEvent& event) {
      return event.name == chart_.events[static_cast<std::size_t>(transition.on)];
    };
    const auto event = std::ranges::find_if(events_, named);
    return event != events_.end() &&
           std::ranges::any_of(event->fields, [&](const auto& one) { return one.optional && one.name == field; });
  }

  // A field that stands in one place only, where it is calculated with or its order is asked for.
  void optional(const EventReader& reader, const Tokens& tokens, const std::vector<std::size_t>& reads,
                std::size_t at) {
    const std::string& field = tokens[at + 6].text;
    const auto same = [&](std::size_t read) { return tokens[read + 6].text == field; };
    if (std::ranges::count_if(reads, same) != 1) return;
    const auto missing = [&](const Chart::Transition* one) { return may_be_missing(*one, field); };
    if (std::ranges::none_of(reader.transitions, missing)) return;
    const auto needs = [](const SourceToken& token) {
      return token.is_any({"+", "-", "*", "/", "%", "^", "<", ">", "<=", ">=", ".."});
    };
    if (!needs(tokens[at - 1]) && !needs(tokens[at + 7])) return;
    const std::string name = tokens[at].text + ".event.data." + field;
    problems_.push_back({reader.function.chunk, tokens[at].line, 0,
                         name + " may be nil, k.events says optional: test it, or write (" + name + " or 0)"});
  }

  const Chart& chart_;
  const std::vector<ScriptEvent>& events_;
  const ChartFunctions& functions_;
  std::vector<InputProblem>& problems_;
};

}  // namespace

void check_event_data(Behavior::Parts& parts, std::vector<InputProblem>& problems) {
  const ChartFunctions functions = chart_functions(parts);
  std::map<const void*, EventReader> readers;
  for (const Chart::Transition& one : parts.chart.transitions) {
    for (const bool guard : {true, false}) {
      const auto function = functions.by_reference.find(guard ? one.when : one.action);
      if (function == functions.by_reference.end()) continue;
      EventReader& reader = readers[function->second.identity];
      reader.function = function->second;
      reader.guard = guard;
      reader.transitions.push_back(&one);
    }
  }
  EventDataCheck check(parts, functions, problems);
  for (const auto& [identity, reader] : readers) check.look(reader);
}

}  // namespace kadans
