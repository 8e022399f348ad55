#include "check_events.h"

#include <algorithm>
#include <set>

#include "hint.h"

namespace kadans {
namespace {

using Kind = SourceToken::Kind;
using Tokens = std::vector<SourceToken>;

// What the functions emit, as far as their text tells.
struct Emitted {
  std::set<std::string> events;
  std::set<std::string> beginnings;  // of those that are put together: "refused:" .. why
  bool unknown = false;              // one that only the run knows

  bool may_be(const std::string& event) const {
    return unknown || events.contains(event) ||
           std::ranges::any_of(beginnings, [&](const std::string& start) { return event.starts_with(start); });
  }
};

// The values that an argument may have, from `at` up to `end`: `a and "b" or "c"` is b or c.
void add_values(const Tokens& tokens, std::size_t at, std::size_t end, Emitted& emitted) {
  int depth = 0;
  std::size_t value = at;
  const auto take = [&](std::size_t from, std::size_t to) {
    const bool text = from < to && tokens[from].kind == Kind::text;
    if (text && to == from + 1) {
      emitted.events.insert(tokens[from].text);
    } else if (text && tokens[from + 1].is("..")) {
      emitted.beginnings.insert(tokens[from].text);
    } else {
      emitted.unknown = true;
    }
  };
  for (std::size_t i = at; i < end; ++i) {
    for (const char* opening : {"(", "{", "[", "function"}) depth += tokens[i].is(opening) ? 1 : 0;
    for (const char* closing : {")", "}", "]", "end"}) depth -= tokens[i].is(closing) ? 1 : 0;
    if (depth != 0) continue;
    if (tokens[i].is("and")) value = i + 1;
    if (!tokens[i].is("or")) continue;
    take(value, i);
    value = i + 1;
  }
  take(value, end);
}

void add_emitted(const Tokens& tokens, Emitted& emitted) {
  for (std::size_t i = 1; i + 2 < tokens.size(); ++i) {
    const bool name = tokens[i].kind == Kind::name || tokens[i].kind == Kind::text;
    if (!name || tokens[i].text != "emit") continue;
    const bool method = tokens[i].kind == Kind::name && tokens[i - 1].is(":");
    if (method && tokens[i + 1].kind == Kind::text) {
      emitted.events.insert(tokens[i + 1].text);
    } else if (method && tokens[i + 1].is("(")) {
      add_values(tokens, i + 2, end_of_call(tokens, i + 2) - 1, emitted);
    } else {
      emitted.unknown = true;  // m.emit as a value, m["emit"]
    }
  }
}

// How what is inside a state may end: events that only it, not what is around it, hears.
std::set<std::string> outcomes_of(const Chart& chart, StateIndex index) {
  std::set<std::string> outcomes;
  const bool parallel = chart.states[index].kind == Chart::Kind::parallel;
  for (StateIndex i = static_cast<StateIndex>(index + 1); i < chart.states[index].end; ++i) {
    const Chart::State& child = chart.states[i];
    if (child.parent != index) continue;
    if (child.kind == Chart::Kind::final_state) outcomes.insert(child.outcome_name);
    if (parallel || child.machine_root) outcomes.merge(outcomes_of(chart, i));
  }
  return outcomes;
}

// A behavior that is called may end in other ways tomorrow: waiting for the usual ones is foresight.
bool ends_by_others(const Chart& chart, StateIndex index) {
  const bool parallel = chart.states[index].kind == Chart::Kind::parallel;
  for (StateIndex i = static_cast<StateIndex>(index + 1); i < chart.states[index].end; ++i) {
    if (chart.states[i].parent != index) continue;
    if (chart.states[i].machine_root || (parallel && ends_by_others(chart, i))) return true;
  }
  return false;
}

}  // namespace

void check_events(const Chart& chart, const std::vector<ReadSource>& read, std::vector<InputProblem>& problems) {
  Emitted emitted;
  for (const ReadSource& one : read) add_emitted(one.scopes.tokens(), emitted);
  for (const Chart::Transition& transition : chart.transitions) {
    if (transition.on == no_event || transition.on == run_done_event) continue;
    const std::string& event = chart.events[static_cast<std::size_t>(transition.on)];
    if (emitted.may_be(event)) continue;
    std::set<std::string> known = outcomes_of(chart, transition.source);
    if (ends_by_others(chart, transition.source)) known.insert({"done", "failed"});
    if (known.contains(event)) continue;
    known.insert(emitted.events.begin(), emitted.events.end());
    problems.push_back(
        {chart.states[transition.source].chunk, transition.line, 0,
         "nobody emits the event '" + event + "' here" + hint_text(event, {known.begin(), known.end()})});
  }
}

}  // namespace kadans
