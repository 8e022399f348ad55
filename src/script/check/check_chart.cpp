#include "check_chart.h"

#include <algorithm>

namespace kadans {
namespace {

class ChartCheck {
 public:
  ChartCheck(const Chart& chart, std::vector<InputProblem>& problems)
      : chart_(chart), problems_(problems), reached_(chart.states.size(), false) {}

  void run() {
    find_reached();
    for (StateIndex i = 0; i < chart_.size(); ++i) {
      const Chart::State& state = chart_.states[i];
      never_entered(i);
      if (reached_[i] && state.kind != Chart::Kind::history) {
        no_way_out(i);
        shadowed(i, state.first_transition, state.transition_count);
        shadowed(i, state.first_always, state.always_count);
        run_done_without_run(i);
      }
      if (state.kind == Chart::Kind::final_state && !state.outcome_given) {
        problem(state, state.line, "final '" + state.name + "' does not say how it ended: outcome = \"done\"?");
      }
    }
  }

 private:
  void problem(const Chart::State& state, int line, std::string message) {
    problems_.push_back({state.chunk, line, 0, std::move(message)});
  }

  void find_reached() {
    enter(0);
    for (bool more = true; more;) {
      more = false;
      for (const Chart::Transition& transition : chart_.transitions) {
        if (!reached_[transition.source] || reached_[transition.target]) continue;
        enter(transition.target);
        more = true;
      }
    }
  }

  // The state, those around it, and what is entered with them.
  void enter(StateIndex index) {
    std::vector<StateIndex> waiting{index};
    while (!waiting.empty()) {
      const StateIndex at = waiting.back();
      waiting.pop_back();
      if (reached_[at]) continue;
      reached_[at] = true;
      const Chart::State& state = chart_.states[at];
      if (state.parent != no_state && !reached_[state.parent]) waiting.push_back(state.parent);
      // A transition past `initial` still makes the parent's default reachable only through the parent itself.
      if (state.initial != no_state && at_entry(at, index)) waiting.push_back(state.initial);
      for (StateIndex i = at + 1; i < state.end; ++i) {
        const bool region = state.kind == Chart::Kind::parallel && chart_.states[i].parent == at;
        const bool called = chart_.states[i].machine_root && chart_.states[i].parent == at && state.initial == no_state;
        if (region || called) waiting.push_back(i);
      }
    }
  }

  // Whether entering `target` enters `at` by default, not on the way to something inside it.
  bool at_entry(StateIndex at, StateIndex target) const { return at == target || !chart_.inside(target, at); }

  void never_entered(StateIndex index) {
    const Chart::State& state = chart_.states[index];
    if (reached_[index] || state.parent == no_state || !reached_[state.parent]) return;
    problem(state, state.line, "state '" + state.name + "' is never entered: no transition leads to it");
  }

  void no_way_out(StateIndex index) {
    const Chart::State& state = chart_.states[index];
    const bool leaf = state.end == index + 1;
    if (!leaf || state.kind == Chart::Kind::final_state || state.kind == Chart::Kind::parallel) return;
    for (StateIndex around = index; around != no_state; around = chart_.states[around].parent) {
      const Chart::State& at = chart_.states[around];
      if (at.endless || at.transition_count > 0) return;
      const auto leads_away = [&](std::uint16_t number) { return chart_.transitions[number].target != index; };
      for (std::uint16_t i = 0; i < at.always_count; ++i) {
        if (leads_away(static_cast<std::uint16_t>(at.first_always + i))) return;
      }
    }
    const std::string shown = state.name.empty() ? chart_.name : state.name;
    problem(state, state.line, "state '" + shown + "' has no way out: give it a transition, or say endless = true");
  }

  void shadowed(StateIndex index, std::uint16_t first, std::uint16_t count) {
    for (std::uint16_t i = 0; i + 1 < count; ++i) {
      const Chart::Transition& transition = chart_.transitions[static_cast<std::size_t>(first) + i];
      if (transition.when != Chart::no_function || transition.on != no_event || transition.timed) continue;
      problem(chart_.states[index], chart_.transitions[static_cast<std::size_t>(first) + i + 1].line,
              "this transition is never looked at: the one before it, to '" + transition.target_name +
                  "', is always taken");
      return;
    }
  }

  void run_done_without_run(StateIndex index) {
    const Chart::State& state = chart_.states[index];
    for (std::uint16_t i = 0; i < state.transition_count; ++i) {
      const Chart::Transition& transition = chart_.transitions[static_cast<std::size_t>(state.first_transition) + i];
      if (transition.on != run_done_event || state.run != Chart::no_function) continue;
      problem(state, transition.line, "state '" + state.name + "' waits for \"run.done\", but it has no run");
    }
  }

  const Chart& chart_;
  std::vector<InputProblem>& problems_;
  std::vector<bool> reached_;
};

}  // namespace

void check_chart(const Chart& chart, std::vector<InputProblem>& problems) { ChartCheck(chart, problems).run(); }

}  // namespace kadans
