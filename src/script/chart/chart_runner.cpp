#include "chart_runner.h"

#include <algorithm>

#include <lua.hpp>

#include "script/bindings/bindings.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

constexpr std::size_t state_steps = 2;  // to look at a state for one transition

constexpr std::uint16_t none = 0xffff;
constexpr std::size_t transition_steps = 6, selected_steps = 6;  // to look at one

}  // namespace

ChartRunner::ChartRunner(const Chart& chart, const RunnerTables& tables, TransitionSink& sink)
    : chart_(chart),
      tables_(tables),
      sink_(sink),
      run_(chart.states.size()),
      guards_(chart.transitions.size(), Guard::unknown),
      histories_(chart.states.size()),
      remembered_(chart.states.size(), false) {
  active_.reserve(chart.states.size());
  selected_.reserve(chart.transitions.size() + 1);
  for (std::size_t i = 0; i < chart.states.size(); ++i) {
    if (chart.states[i].kind == Chart::Kind::history) histories_[i].assign(chart.states.size(), false);
  }
}

bool ChartRunner::post(EventId event) noexcept {
  if (event_count_ == events_.size()) return false;
  events_[(event_first_ + event_count_++) % events_.size()] = event;
  return true;
}

void ChartRunner::tick(lua_State* state, std::int64_t now_ns) {
  now_ns_ = now_ns;
  if (finished_) return;
  selected_.clear();
  if (!started_) {
    started_ = true;
    mark_entry(0);
  } else if (filling_) {
    filling_ = false;
  } else {
    std::fill(guards_.begin(), guards_.end(), Guard::unknown);
    look_for_transitions(state);
  }
  take_step(state);
  if (run_[0].outcome != no_event) return stop(state, now_ns);
  for (const StateIndex index : active_) {
    if (chart_.states[index].during != Chart::no_function) call(state, chart_.states[index].during, index);
  }
  for (const StateIndex index : active_) {
    if (run_[index].thread != nullptr) resume_run(state, index);
  }
}

// Among the events that waited when the tick began: what a guard emits is for the next one.
void ChartRunner::look_for_transitions(lua_State* state) {
  std::uint32_t waiting = event_count_;
  const auto oldest = [&] { return waiting > 0 ? events_[event_first_] : no_event; };
  select(state, oldest(), false);
  while (waiting > 0) {
    const bool taken = took(oldest());
    if (!taken && !selected_.empty()) return;
    event_first_ = static_cast<std::uint32_t>((event_first_ + 1) % events_.size());
    --event_count_;
    --waiting;
    if (taken) return;
    ++unhandled_;
    if (waiting > 0) select(state, oldest(), true);
  }
}

void ChartRunner::stop(lua_State* state, std::int64_t now_ns) {
  now_ns_ = now_ns;
  finished_ = true;
  list_active();
  while (!active_.empty()) {  // an exit that raises is not run again
    const StateIndex innermost = active_.back();
    active_.pop_back();
    leave(state, innermost);
  }
}

void ChartRunner::take_step(lua_State* state) {
  if (selected_.empty() && !entering_) return;
  StepMeter meter(state);
  meter.spend(state_steps * selected_.size() * (active_.size() + chart_.size()));
  meter.settle();
  for (const std::uint16_t number : selected_) report(number);
  for (const StateIndex index : active_) {
    for (const std::uint16_t number : selected_) {
      const StateIndex domain = chart_.transitions[number].domain;
      if (index != domain && chart_.inside(index, domain)) run_[index].leaving = true;
    }
  }
  for (const StateIndex index : active_) {
    if (run_[index].leaving) remember(index);
  }
  for (std::size_t i = active_.size(); i > 0; --i) {
    if (run_[active_[i - 1]].leaving) leave(state, active_[i - 1]);
  }
  for (const std::uint16_t number : selected_) {
    const Chart::Transition& transition = chart_.transitions[number];
    if (transition.action != Chart::no_function) call(state, transition.action, transition.source);
  }
  for (const std::uint16_t number : selected_) {
    const Chart::Transition& transition = chart_.transitions[number];
    mark_entry(transition.target);
    mark_ancestors(transition.target, transition.domain);
  }
  entering_ = false;
  for (StateIndex index = 0; index < chart_.size(); ++index) {
    if (!run_[index].entering) continue;
    run_[index].entering = false;
    if (!run_[index].active) enter(state, index);
  }
  list_active();
}

void ChartRunner::leave(lua_State* state, StateIndex index) {
  StateRun& run = run_[index];
  run.active = false;
  run.leaving = false;
  run.outcome = index == 0 ? run.outcome : no_event;
  if (chart_.states[index].kind == Chart::Kind::final_state) go_on(chart_.states[index].parent);
  cancel_run(state, index);
  if (chart_.states[index].exit != Chart::no_function) call(state, chart_.states[index].exit, index);
}

void ChartRunner::enter(lua_State* state, StateIndex index) {
  const Chart::State& entered = chart_.states[index];
  StateRun& run = run_[index];
  run.active = true;
  run.run_done = false;
  run.outcome = no_event;
  run.entered_ns = now_ns_;
  if (entered.machine_root) {  // a call begins anew: nothing is left of the one before
    bindings_of(state).bring_in(entered.machine);
    renew_machine(state, chart_, tables_, entered.machine);
    for (StateIndex i = index; i < entered.end; ++i) remembered_[i] = false;
  }
  if (entered.enter != Chart::no_function) call(state, entered.enter, index);
  if (entered.run != Chart::no_function) start_run(state, index);
  if (entered.kind == Chart::Kind::final_state) complete(entered.parent, entered.outcome);
}

// `index` came to an end with this outcome; so did, perhaps, what is around it.
void ChartRunner::complete(StateIndex index, EventId outcome) noexcept {
  run_[index].outcome = outcome;
  const Chart::State& ended = chart_.states[index];
  if (index == 0) return;
  if (ended.machine_root) return complete(ended.parent, outcome);
  if (ended.kind != Chart::Kind::region) return;
  EventId together = no_event;  // the first outcome that is not "done", else "done"
  for (StateIndex region = static_cast<StateIndex>(ended.parent + 1); region < chart_.states[ended.parent].end;
       region = chart_.states[region].end) {
    const EventId its = run_[region].outcome;
    if (its == no_event) return;
    if (together == no_event || chart_.events[static_cast<std::size_t>(together)] == "done") together = its;
  }
  run_[ended.parent].outcome = together;
}

// The opposite: a final state of `index` is left while what is around it stays.
void ChartRunner::go_on(StateIndex index) noexcept {
  if (index == 0) return;
  run_[index].outcome = no_event;
  const Chart::State& ended = chart_.states[index];
  if (ended.machine_root) return go_on(ended.parent);
  if (ended.kind == Chart::Kind::region) run_[ended.parent].outcome = no_event;
}

bool ChartRunner::marked_inside(StateIndex index) const noexcept {
  for (StateIndex i = static_cast<StateIndex>(index + 1); i < chart_.states[index].end; ++i) {
    if (run_[i].entering) return true;
  }
  return false;
}

void ChartRunner::mark_entry(StateIndex target) noexcept {
  const Chart::State& entered = chart_.states[target];
  if (entered.kind == Chart::Kind::history) return mark_history(target);
  entering_ = run_[target].entering = true;
  if (marked_inside(target) && entered.kind != Chart::Kind::parallel) return;
  if (entered.kind == Chart::Kind::parallel) {
    for (StateIndex region = static_cast<StateIndex>(target + 1); region < entered.end;
         region = chart_.states[region].end) {
      if (!run_[region].entering) mark_entry(region);
    }
  } else if (entered.initial != no_state) {
    mark_entry(entered.initial);
    mark_ancestors(entered.initial, target);
  }
}

// What lies between a target and the domain of its transition; a parallel on the way starts its other regions too.
void ChartRunner::mark_ancestors(StateIndex target, StateIndex domain) noexcept {
  for (StateIndex index = chart_.states[target].parent; index != no_state && index != domain;
       index = chart_.states[index].parent) {
    run_[index].entering = true;
    if (chart_.states[index].kind == Chart::Kind::parallel) mark_entry(index);
  }
}

void ChartRunner::mark_history(StateIndex history) noexcept {
  const StateIndex parent = chart_.states[history].parent;
  if (!remembered_[history]) {
    const StateIndex fallback = chart_.states[history].initial;
    if (fallback == no_state) return;
    mark_entry(fallback);
    return mark_ancestors(fallback, parent);
  }
  for (StateIndex i = static_cast<StateIndex>(parent + 1); i < chart_.states[parent].end; ++i) {
    if (histories_[history][i] && chart_.states[history].deep) entering_ = run_[i].entering = true;
  }
  for (StateIndex i = static_cast<StateIndex>(parent + 1); i < chart_.states[parent].end; ++i) {
    if (histories_[history][i] && !chart_.states[history].deep && chart_.states[i].parent == parent) mark_entry(i);
  }
}

// Before `index` is left: its history states note what is active in it.
void ChartRunner::remember(StateIndex index) noexcept {
  for (StateIndex history = static_cast<StateIndex>(index + 1); history < chart_.states[index].end; ++history) {
    if (chart_.states[history].parent != index || chart_.states[history].kind != Chart::Kind::history) continue;
    for (StateIndex i = static_cast<StateIndex>(index + 1); i < chart_.states[index].end; ++i) {
      histories_[history][i] = run_[i].active;
    }
    remembered_[history] = true;
  }
}

void ChartRunner::list_active() noexcept {
  active_.clear();
  for (StateIndex index = 0; index < chart_.size(); ++index) {
    if (run_[index].active) active_.push_back(index);
  }
}

// The innermost active state of what the transition leaves, and where it leads.
void ChartRunner::report(std::uint16_t number) noexcept {
  const Chart::Transition& transition = chart_.transitions[number];
  StateIndex from = transition.source;
  for (const StateIndex index : active_) {
    if (chart_.states[index].parent == from) from = index;
  }
  sink_.transitioned(chart_.states[from].path, chart_.states[transition.target].path, transition.why);
}

double ChartRunner::state_time_s(StateIndex state) const noexcept {
  return static_cast<double>(now_ns_ - run_[state].entered_ns) / 1e9;
}

bool ChartRunner::guard(lua_State* state, std::uint16_t number) {
  const Chart::Transition& transition = chart_.transitions[number];
  if (transition.when == Chart::no_function) return true;
  if (guards_[number] == Guard::unknown) {  // several innermost states may ask
    set_time(state, transition.source);
    core_of(state).called = transition.when;
    lua_rawgeti(state, LUA_REGISTRYINDEX, transition.when);
    lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.snapshot);
    lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[transition.source].machine].handle);
    lua_call(state, 2, 1);
    guards_[number] = lua_toboolean(state, -1) != 0 ? Guard::yes : Guard::no;
    lua_pop(state, 1);
  }
  return guards_[number] == Guard::yes;
}

bool ChartRunner::enabled(lua_State* state, std::uint16_t number, EventId event, bool events_only) {
  const Chart::Transition& transition = chart_.transitions[number];
  const StateRun& source = run_[transition.source];
  if (transition.on != no_event) {
    const bool happened = transition.on == event || transition.on == source.outcome ||
                          (transition.on == run_done_event && source.run_done);
    if (!happened) return false;
  } else if (events_only) {
    return false;
  }
  if (transition.timed) {
    const double after_s = transition.after_parameter != Chart::no_parameter
                               ? core_of(state).parameters[static_cast<std::size_t>(transition.after_parameter)].value
                               : transition.after_s;
    if (!(state_time_s(transition.source) >= after_s)) return false;
  }
  return guard(state, number);
}

std::uint16_t ChartRunner::select_always(lua_State* state, StepMeter& meter, StateIndex leaf, EventId event,
                                         bool events_only) {
  for (const StateIndex around : active_) {  // from the outside in
    if (around > leaf) break;
    meter.spend();
    const Chart::State& outer = chart_.states[around];
    if (outer.always_count == 0 || !chart_.inside(leaf, around)) continue;
    for (std::uint16_t i = 0; i < outer.always_count; ++i) {
      const auto number = static_cast<std::uint16_t>(outer.first_always + i);
      meter.spend(transition_steps);
      if (run_[chart_.transitions[number].target].active) continue;  // it is there already
      if (enabled(state, number, event, events_only)) return number;
    }
  }
  return none;
}

std::uint16_t ChartRunner::select_ordinary(lua_State* state, StepMeter& meter, StateIndex leaf, EventId event,
                                           bool events_only) {
  for (StateIndex inner = leaf; inner != no_state; inner = chart_.states[inner].parent) {
    const Chart::State& at = chart_.states[inner];
    for (std::uint16_t i = 0; i < at.transition_count; ++i) {
      meter.spend(transition_steps);
      const auto number = static_cast<std::uint16_t>(at.first_transition + i);
      if (enabled(state, number, event, events_only)) return number;
    }
  }
  return none;
}

// Keeps `selected_` free of transitions that leave the same states.
void ChartRunner::add_selected(std::uint16_t added) noexcept {
  const Chart::Transition& transition = chart_.transitions[added];
  for (const std::uint16_t other : selected_) {
    if (other == added) return;
    const Chart::Transition& earlier = chart_.transitions[other];
    const bool conflict =
        chart_.inside(transition.domain, earlier.domain) || chart_.inside(earlier.domain, transition.domain);
    const bool further_inside = transition.source != earlier.source && chart_.inside(transition.source, earlier.source);
    if (conflict && !further_inside) return;
  }
  std::erase_if(selected_, [&](std::uint16_t other) {
    const Chart::Transition& earlier = chart_.transitions[other];
    return chart_.inside(transition.domain, earlier.domain) || chart_.inside(earlier.domain, transition.domain);
  });
  selected_.push_back(added);
}

bool ChartRunner::is_leaf(std::size_t position) const noexcept {
  return position + 1 == active_.size() || !chart_.inside(active_[position + 1], active_[position]);
}

void ChartRunner::select(lua_State* state, EventId event, bool events_only) {
  StepMeter meter(state);
  selected_.clear();
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (!is_leaf(i)) continue;
    const std::uint16_t found = select_always(state, meter, active_[i], event, events_only);
    run_[active_[i]].decided = found != none;
    if (found == none) continue;
    meter.spend(selected_steps * selected_.size());
    add_selected(found);
  }
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (!is_leaf(i) || run_[active_[i]].decided) continue;
    const std::uint16_t found = select_ordinary(state, meter, active_[i], event, events_only);
    if (found == none) continue;
    meter.spend(selected_steps * selected_.size());
    add_selected(found);
  }
  meter.settle();
}

bool ChartRunner::took(EventId event) const noexcept {
  return std::any_of(selected_.begin(), selected_.end(),
                     [&](std::uint16_t number) { return chart_.transitions[number].on == event; });
}

}  // namespace kadans
