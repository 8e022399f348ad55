#include "chart.h"

#include <algorithm>

#include "chart_reports.h"
#include "script/check/hint.h"

namespace kadans {
namespace {

constexpr std::size_t problems_max = 20;

std::string last_part(const std::string& path, const std::string& above) {
  return above.empty() ? path : path.substr(above.size() + 1);
}

// The names that `to` may use in a machine: those of its states.
std::vector<std::string> names_in(const Chart& chart, std::uint16_t machine) {
  std::vector<std::string> names;
  for (const Chart::State& state : chart.states) {
    if (state.machine == machine && !state.machine_root) names.push_back(state.name);
  }
  return names;
}

// Nearest first: a child of `from`, a sibling, a sibling of its parent ...; then the only one of that name anywhere in
// the machine. A dotted path is looked up from the machine's root.
StateIndex find_target(const Chart& chart, StateIndex from, const std::string& name, bool& ambiguous) {
  const Chart::State& source = chart.states[from];
  const StateIndex root = chart.machines[source.machine].root;
  const std::string& above = chart.states[root].path;
  StateIndex found = no_state;
  for (StateIndex scope = from;; scope = chart.states[scope].parent) {
    for (StateIndex i = scope + 1; i < chart.states[scope].end; ++i) {
      if (chart.states[i].parent == scope && chart.states[i].machine == source.machine && chart.states[i].name == name)
        return i;
    }
    if (scope == root) break;
  }
  for (StateIndex i = root + 1; i < chart.states[root].end; ++i) {
    const Chart::State& state = chart.states[i];
    if (state.machine != source.machine) continue;
    if (last_part(state.path, above) == name) return i;
    if (state.name != name) continue;
    ambiguous = found != no_state;
    if (ambiguous) return no_state;
    found = i;
  }
  return found;
}

// The innermost state around source and target that is left by neither: never a parallel, nor the target itself, which
// is left and entered again when it is around the source (SCXML).
StateIndex domain_of(const Chart& chart, StateIndex source, StateIndex target) {
  StateIndex domain = source;
  if (source == 0 || chart.states[source].machine_root) return source;
  do {
    domain = chart.states[domain].parent;
  } while (domain != 0 &&
           (domain == target || !chart.inside(target, domain) || chart.states[domain].kind == Chart::Kind::parallel));
  return domain;
}

struct Resolver {
  Chart& chart;
  std::vector<InputProblem>& problems;

  void problem(const Chart::State& state, int line, std::string message) {
    problems.push_back({state.chunk, line, 0, std::move(message)});
  }

  void siblings(StateIndex parent) {
    for (StateIndex i = parent + 1; i < chart.states[parent].end; ++i) {
      if (chart.states[i].parent != parent) continue;
      for (StateIndex j = parent + 1; j < i; ++j) {
        if (chart.states[j].parent == parent && chart.states[j].name == chart.states[i].name) {
          problem(chart.states[i], chart.states[i].line,
                  "a second state '" + chart.states[i].name + "' beside the one in line " +
                      std::to_string(chart.states[j].line));
        }
      }
    }
  }

  void initial(StateIndex index) {
    Chart::State& state = chart.states[index];
    std::vector<std::string> names;
    StateIndex first = no_state;
    for (StateIndex i = index + 1; i < state.end; ++i) {
      const Chart::State& child = chart.states[i];
      if (child.parent != index || child.kind == Chart::Kind::history) continue;
      if (first == no_state) first = i;
      names.push_back(child.name);
      if (child.name == state.initial_name) state.initial = i;
    }
    if (state.kind == Chart::Kind::parallel || state.initial != no_state) return;
    if (!state.initial_name.empty()) {
      problem(state, state.line,
              "unknown initial state '" + state.initial_name + "'" + hint_text(state.initial_name, names));
    } else if (names.size() == 1) {
      state.initial = first;
    } else if (names.size() > 1) {
      problem(state, state.line,
              (state.name.empty() ? "this" : "'" + state.name + "'") +
                  std::string(" needs initial = \"...\": one of its states"));
    }
  }

  void history(StateIndex index) {
    Chart::State& state = chart.states[index];
    state.initial = chart.states[state.parent].initial;
    if (state.initial_name.empty()) return;
    bool ambiguous = false;
    const StateIndex target = find_target(chart, state.parent, state.initial_name, ambiguous);
    if (target != no_state && chart.inside(target, state.parent) && target != state.parent) {
      state.initial = target;
    } else {
      problem(state, state.line,
              "history '" + state.name + "' leads to an unknown state '" + state.initial_name + "'" +
                  hint_text(state.initial_name, names_in(chart, state.machine)));
    }
  }

  void transition(Chart::Transition& transition) {
    const Chart::State& source = chart.states[transition.source];
    bool ambiguous = false;
    transition.target = find_target(chart, transition.source, transition.target_name, ambiguous);
    if (transition.target == no_state) {
      problem(source, transition.line,
              ambiguous ? "there are several states '" + transition.target_name + "': write its path, with dots"
                        : "unknown state '" + transition.target_name + "' in 'to'" +
                              hint_text(transition.target_name, names_in(chart, source.machine)));
      return;
    }
    if (chart.states[transition.target].kind == Chart::Kind::region) {
      problem(source, transition.line,
              "'" + transition.target_name + "' is a region: lead to its k.parallel or to a state in it");
    }
    transition.domain = domain_of(chart, transition.source, transition.target);
  }

  void kinds(StateIndex index) {
    const Chart::State& state = chart.states[index];
    if (index == 0) return;
    const Chart::Kind parent = chart.states[state.parent].kind;
    if (state.kind == Chart::Kind::region && parent != Chart::Kind::parallel)
      problem(state, state.line, "k.region '" + state.name + "' belongs into a k.parallel");
    if (state.kind != Chart::Kind::region && parent == Chart::Kind::parallel)
      problem(state, state.line, "a k.parallel holds k.region, and transitions; '" + state.name + "' is neither");
    if (state.kind == Chart::Kind::history && chart.states[state.parent].machine_root)
      problem(state, state.line,
              "k.history '" + state.name +
                  "' remembers a state that is left; a behavior is not: put "
                  "it into the state whose states it shall remember");
    if (state.kind == Chart::Kind::parallel && state.end == index + 1)
      problem(state, state.line, "k.parallel '" + state.name + "' has no k.region");
  }
};

}  // namespace

EventId Chart::find_event(std::string_view event) const noexcept {
  const auto found = std::find(events.begin(), events.end(), event);
  return found == events.end() ? no_event : static_cast<EventId>(found - events.begin());
}

EventId Chart::intern(std::string_view event) {
  const EventId known = find_event(event);
  if (known != no_event) return known;
  events.emplace_back(event);
  return static_cast<EventId>(events.size() - 1);
}

bool Chart::is_report(EventId event) const noexcept {
  return event != no_event &&
         (event == error_event || event == refused_event ||
          std::ranges::find(fault_events, event, &std::pair<FaultCode, EventId>::second) != fault_events.end());
}

bool Chart::hears_end(StateIndex state, StateIndex ended) const noexcept {
  if (state == no_state || !inside(ended, state) || states[state].machine != states[ended].machine) return false;
  for (StateIndex index = ended; index != state; index = states[index].parent) {
    if (states[index].kind == Kind::region) return false;
  }
  return true;
}

void Chart::resolve(std::vector<InputProblem>& problems) {
  Resolver resolver{*this, problems};
  // Each mistake goes through all names; who reads them mends the first ones first.
  const auto enough = [&] { return problems.size() >= problems_max; };
  for (StateIndex i = 0; i < size() && !enough(); ++i) {
    resolver.siblings(i);
    resolver.kinds(i);
    if (states[i].kind != Kind::history) resolver.initial(i);
  }
  for (StateIndex i = 0; i < size() && !enough(); ++i) {
    if (states[i].kind == Kind::history) resolver.history(i);
  }
  for (std::size_t i = 0; i < transitions.size() && !enough(); ++i) resolver.transition(transitions[i]);
  find_reports(*this, problems);
  ends_.assign(events.size(), false);
  ends_[run_done_event] = ends_[done_event] = true;
  for (const State& state : states) {
    if (state.outcome != no_event) ends_[static_cast<std::size_t>(state.outcome)] = true;
  }
  for (EventId event = 0; event < static_cast<EventId>(events.size()); ++event) {
    if (is_report(event)) ends_[static_cast<std::size_t>(event)] = true;
  }
}

}  // namespace kadans
