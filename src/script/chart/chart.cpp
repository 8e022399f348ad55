#include "chart.h"

#include <algorithm>

#include "script/check/hint.h"

namespace kadans {
namespace {

constexpr std::size_t problems_max = 20;

// The names that `to` may use in a machine: those of its states.
std::vector<std::string> names_in(const Chart& chart, std::uint16_t machine) {
  std::vector<std::string> names;
  for (const Chart::State& state : chart.states) {
    if (state.machine == machine && !state.machine_root) names.push_back(state.name);
  }
  return names;
}

std::string below(const std::string& above, const std::string& name) {
  return above.empty() ? name : above + "." + name;
}

// Nearest first: a child of `from`, a sibling, a sibling of its parent ...; then the only one of that name anywhere in
// the machine. A dotted path begins at the machine's root, else at the nearest state from which it leads anywhere, else
// it is the end of one path only.
StateIndex find_target(const Chart& chart, StateIndex from, const std::string& name, bool& ambiguous) {
  const Chart::State& source = chart.states[from];
  const StateIndex root = chart.machines[source.machine].root;
  const bool dotted = name.find('.') != std::string::npos;
  const auto at = [&](StateIndex scope) {
    const std::string path = dotted ? below(chart.states[scope].path, name) : "";
    for (StateIndex i = scope + 1; i < chart.states[scope].end; i = dotted ? i + 1 : chart.states[i].end) {
      const Chart::State& state = chart.states[i];
      if (state.machine == source.machine && (dotted ? state.path == path : state.name == name)) return i;
    }
    return no_state;
  };
  StateIndex found = dotted ? at(root) : no_state;
  for (StateIndex scope = from; found == no_state; scope = chart.states[scope].parent) {
    found = at(scope);
    if (scope == root) break;
  }
  if (found != no_state) return found;
  for (StateIndex i = root + 1; i < chart.states[root].end; ++i) {
    const Chart::State& state = chart.states[i];
    if (state.machine != source.machine) continue;
    if (dotted ? !state.path.ends_with("." + name) : state.name != name) continue;
    ambiguous = found != no_state;
    if (ambiguous) return no_state;
    found = i;
  }
  return found;
}

// The innermost state around source and targets that is left by none of them: never a parallel, nor a target itself,
// which is left and entered again when it is around the source (SCXML, getTransitionDomain).
StateIndex domain_of(const Chart& chart, const Chart::Transition& transition) {
  StateIndex domain = transition.source;
  if (transition.internal || domain == 0 || chart.states[domain].machine_root) return domain;
  bool around = false;
  do {
    domain = chart.states[domain].parent;
    around = chart.states[domain].kind != Chart::Kind::parallel;
    transition.each_target(
        [&](StateIndex target) { around = around && domain != target && chart.inside(target, domain); });
  } while (domain != 0 && !around);
  return domain;
}

StateIndex child_around(const Chart& chart, StateIndex ancestor, StateIndex state) {
  while (chart.states[state].parent != ancestor) state = chart.states[state].parent;
  return state;
}

struct Resolver {
  Chart& chart;
  std::vector<InputProblem>& problems;

  void problem(const Chart::State& state, int line, std::string message) {
    problems.push_back({state.chunk, line, 0, std::move(message)});
  }

  void siblings(StateIndex parent) {
    chart.each_child(parent, [&](StateIndex later) {
      const Chart::State& state = chart.states[later];
      chart.each_child(parent, [&](StateIndex other) {
        if (other < later && chart.states[other].name == state.name)
          problem(
              state, state.line,
              "a second state '" + state.name + "' beside the one in line " + std::to_string(chart.states[other].line));
      });
    });
  }

  std::string title(StateIndex index) const { return "'" + chart.states[index].path + "'"; }

  // Why two targets cannot be active together; "" when they can: they are in different regions of one parallel.
  std::string clash(StateIndex one, StateIndex other) const {
    if (chart.inside(one, other)) std::swap(one, other);
    if (one == other) return title(one) + " is named twice";
    if (chart.inside(other, one)) return title(other) + " is inside " + title(one) + ": name the inner one alone";
    StateIndex around = one;
    while (!chart.inside(other, around)) around = chart.states[around].parent;
    if (chart.states[around].kind != Chart::Kind::parallel) {
      StateIndex region = around;
      while (region != no_state && chart.states[region].kind != Chart::Kind::region)
        region = chart.states[region].parent;
      return title(one) + " and " + title(other) + " cannot be active together: " +
             (region != no_state ? "both are in region " + title(region) + ", name one state of each region"
                                 : "several targets are states in regions of one k.parallel");
    }
    for (const StateIndex its : {one, other}) {
      if (chart.states[its].kind == Chart::Kind::history && chart.states[its].parent == around)
        return title(its) + " brings back all regions: name it alone";
    }
    return "";
  }

  // The targets of these names, as `find` finds one. A mistake is told, and nothing is returned.
  template <typename Find>
  std::vector<StateIndex> targets(const Chart::State& state, int line, const std::vector<std::string>& names,
                                  Find find) {
    std::vector<StateIndex> found;
    for (const std::string& name : names) {
      const StateIndex target = find(name);
      if (target == no_state) return {};
      if (chart.states[target].kind == Chart::Kind::region) {
        problem(state, line, "'" + name + "' is a region: lead to its k.parallel or to a state in it");
        return {};
      }
      for (const StateIndex other : found) {
        const std::string text = clash(other, target);
        if (text.empty()) continue;
        problem(state, line, text);
        return {};
      }
      found.push_back(target);
    }
    return found;
  }

  // [name] of `initial`: a child, or a state further inside by its path from here.
  StateIndex find_inside(StateIndex index, const std::string& name) {
    const Chart::State& state = chart.states[index];
    std::vector<std::string> names;
    std::string deeper;
    for (StateIndex i = index + 1; i < state.end; ++i) {
      const Chart::State& inner = chart.states[i];
      if (inner.path == below(state.path, name) && (inner.parent == index || inner.machine == state.machine)) return i;
      if (inner.parent == index && inner.kind != Chart::Kind::history) names.push_back(inner.name);
      if (inner.name == name) deeper = inner.path.substr(state.path.empty() ? 0 : state.path.size() + 1);
    }
    problem(state, state.line,
            "unknown initial state '" + name + "'" +
                (deeper.empty() ? hint_text(name, names) : ", did you mean '" + deeper + "'?"));
    return no_state;
  }

  void initial(StateIndex index) {
    Chart::State& state = chart.states[index];
    const std::vector<StateIndex> found = targets(state, state.line, state.initial_names,
                                                  [&](const std::string& name) { return find_inside(index, name); });
    if (state.kind == Chart::Kind::parallel) return regions_begin(index, found);
    if (!state.initial_names.empty() && !state.defaults.empty()) {
      problem(state, state.line,
              title(index) + " has an initial of its own, and its k.parallel names another one: keep one of them");
    } else if (!found.empty()) {
      state.defaults = found;
    } else if (state.initial_names.empty() && state.defaults.empty()) {
      only_child(index);
    }
    if (!state.defaults.empty()) state.initial = child_around(chart, index, state.defaults.front());
  }

  // initial = { "a.x", "b.y" } of a parallel says where its regions begin.
  void regions_begin(StateIndex parallel, const std::vector<StateIndex>& found) {
    for (const StateIndex target : found) {
      if (chart.states[target].parent == parallel) {
        problem(chart.states[parallel], chart.states[parallel].line,
                "the initial of a k.parallel names states in its regions, not " + title(target));
      } else {
        chart.states[child_around(chart, parallel, target)].defaults.push_back(target);
      }
    }
  }

  void only_child(StateIndex index) {
    Chart::State& state = chart.states[index];
    chart.each_child(index, [&](StateIndex child) {
      if (chart.states[child].kind != Chart::Kind::history) state.defaults.push_back(child);
    });
    if (state.defaults.size() < 2) return;
    state.defaults.clear();
    problem(state, state.line,
            (state.name.empty() ? "this" : "'" + state.name + "'") +
                std::string(" needs initial = \"...\": one of its states"));
  }

  void history(StateIndex index) {
    Chart::State& state = chart.states[index];
    const auto find = [&](const std::string& name) {
      bool ambiguous = false;
      const StateIndex target = find_target(chart, state.parent, name, ambiguous);
      if (target != no_state && chart.inside(target, state.parent) && target != state.parent) return target;
      problem(state, state.line,
              "history '" + state.name + "' leads to an unknown state '" + name + "'" +
                  hint_text(name, names_in(chart, state.machine)));
      return no_state;
    };
    state.defaults = targets(state, state.line, state.initial_names, find);
    if (state.initial_names.empty()) state.defaults = chart.states[state.parent].defaults;
    if (state.initial_names.empty() && chart.states[state.parent].kind == Chart::Kind::parallel)
      chart.each_region(state.parent, [&](StateIndex region) { state.defaults.push_back(region); });
    for (const StateIndex target : state.defaults) {
      if (chart.states[target].kind == Chart::Kind::history && chart.states[target].parent == state.parent)
        problem(state, state.line,
                "history '" + state.name +
                    "' needs to = \"...\": the state to enter when there is nothing to remember" +
                    (state.initial_names.empty() ? "" : ", not a history"));
    }
    if (!state.defaults.empty()) state.initial = state.defaults.front();
  }

  void transition(Chart::Transition& transition) {
    const Chart::State& source = chart.states[transition.source];
    if (transition.target_names.empty()) {
      transition.once = transition.on == run_done_event || (transition.on == no_event && transition.timed);
      return;
    }
    const auto find = [&](const std::string& name) {
      bool ambiguous = false;
      const StateIndex target = find_target(chart, transition.source, name, ambiguous);
      if (target == no_state)
        problem(source, transition.line,
                ambiguous ? "there are several states '" + name + "': write its path, with dots"
                          : "unknown state '" + name + "' in 'to'" + hint_text(name, names_in(chart, source.machine)));
      return target;
    };
    const std::vector<StateIndex> found = targets(source, transition.line, transition.target_names, find);
    if (found.empty()) return;
    transition.target = found.front();
    transition.also.assign(found.begin() + 1, found.end());
    internal(transition);
    transition.domain = domain_of(chart, transition);
  }

  void internal(Chart::Transition& transition) {
    if (!transition.internal) return;
    const Chart::State& source = chart.states[transition.source];
    if (source.kind == Chart::Kind::parallel) {
      transition.internal = false;
      return problem(
          source, transition.line,
          "internal = true: a k.parallel has no states but its regions; write the transition into the region");
    }
    transition.each_target([&](StateIndex target) {
      if (target != transition.source && chart.inside(target, transition.source)) return;
      problem(source, transition.line,
              "internal = true is for a target inside " +
                  (source.name.empty() ? "the behavior" : title(transition.source)) + ", and " + title(target) +
                  " is not");
    });
  }

  void kinds(StateIndex index) {
    const Chart::State& state = chart.states[index];
    if (index == 0) return;
    const Chart::Kind parent = chart.states[state.parent].kind;
    if (state.kind == Chart::Kind::region && parent != Chart::Kind::parallel)
      problem(state, state.line, "k.region '" + state.name + "' belongs into a k.parallel");
    const bool history = state.kind == Chart::Kind::history;
    if (state.kind != Chart::Kind::region && parent == Chart::Kind::parallel && !history)
      problem(state, state.line, "a k.parallel holds k.region, and transitions; '" + state.name + "' is neither");
    if (history && parent == Chart::Kind::parallel && !state.deep)
      problem(state, state.line,
              "k.history '" + state.name +
                  "' of a k.parallel needs deep = true: its regions are all active, only what is in them differs");
    if (state.kind == Chart::Kind::history && chart.states[state.parent].machine_root)
      problem(state, state.line,
              "k.history '" + state.name +
                  "' remembers a state that is left; a behavior is not: put "
                  "it into the state whose states it shall remember");
    bool empty = true;
    for (StateIndex i = index + 1; i < state.end; ++i) empty = empty && chart.states[i].kind == Chart::Kind::history;
    if (state.kind == Chart::Kind::parallel && empty)
      problem(state, state.line, "k.parallel '" + state.name + "' has no k.region");
  }
};

}  // namespace

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
  find_reports(problems);
  for (const State& state : states) {
    if (state.outcome != no_event) ends_[static_cast<std::size_t>(state.outcome)] = true;
  }
  for (EventId event = 0; event < static_cast<EventId>(events.size()); ++event) {
    if (is_report(event)) ends_[static_cast<std::size_t>(event)] = true;
  }
}

}  // namespace kadans
