// Which transitions a step of a chart takes.
#include <algorithm>

#include <lua.hpp>

#include "chart_calls.h"
#include "chart_runner.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

constexpr std::uint16_t none = 0xffff;
constexpr std::size_t transition_steps = 6, selected_steps = 6;  // to look at one

}  // namespace

// [-0 +3]
void ChartRunner::push_guard(lua_State* state, std::uint16_t number) {
  const Chart::Transition& transition = chart_.transitions[number];
  set_time(state, transition.source);
  core_of(state).called = transition.when;
  lua_rawgeti(state, LUA_REGISTRYINDEX, transition.when);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.snapshot);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[transition.source].machine].handle);
}

void ChartRunner::call_guard(lua_State* state, std::uint16_t number) {
  push_guard(state, number);
  lua_call(state, 2, 1);
}

bool ChartRunner::guard(lua_State* state, std::uint16_t number) {
  const Chart::Transition& transition = chart_.transitions[number];
  if (transition.when == Chart::no_function) return true;
  Guard& guard = guards_[number];
  if (guard.look != look_) {  // several innermost states may ask
    push_guard(state, number);
    const bool answered = call_recoverably(state, transition.source, 2, 1);
    guard.look = look_;
    guard.yes = answered && lua_toboolean(state, -1) != 0;
    if (answered) lua_pop(state, 1);
  }
  return guard.yes;
}

// The end of a coroutine is no event that waits: it is looked at as a guard is.
bool ChartRunner::happened(std::uint16_t number, const WaitingEvent* event) const noexcept {
  const Chart::Transition& transition = chart_.transitions[number];
  if (event == nullptr) {
    if (transition.on == no_event) return true;
    return transition.on == run_done_event && run_[transition.source].run_done && !acted(number);
  }
  if (event->from == no_state) return transition.on == event->id || chart_.takes_by_pattern(transition, event->id);
  if (transition.on != event->id) return false;
  return event->id == chart_.error_event ? chart_.inside(event->from, transition.source)
                                         : chart_.hears_end(transition.source, event->from);
}

// Whether it came already since its state was entered, and comes once.
bool ChartRunner::acted(std::uint16_t number) const noexcept {
  const Chart::Transition& transition = chart_.transitions[number];
  return transition.once && guards_[number].acted_ns == run_[transition.source].entered_ns;
}

bool ChartRunner::due(lua_State* state, std::uint16_t number) const {
  const Chart::Transition& transition = chart_.transitions[number];
  if (!transition.timed || acted(number)) return !transition.timed;
  const bool follows = transition.after_parameter != Chart::no_parameter;
  return state_time_s(transition.source) >=
         (follows ? charged_value(state, static_cast<std::size_t>(transition.after_parameter),
                                  chart_.states[transition.source].machine)
                  : transition.after_s);
}

double ChartRunner::after_s(lua_State* state, const Chart::Transition& transition) const noexcept {
  return transition.after_parameter != Chart::no_parameter
             ? parameter_value(state, static_cast<std::size_t>(transition.after_parameter),
                               chart_.states[transition.source].machine)
             : transition.after_s;
}

bool ChartRunner::enabled(lua_State* state, std::uint16_t number, const WaitingEvent* event) {
  return happened(number, event) && due(state, number) && guard(state, number);
}

std::uint16_t ChartRunner::select_always(lua_State* state, StepMeter& meter, StateIndex leaf,
                                         const WaitingEvent* event) {
  for (const StateIndex around : active_) {  // from the outside in
    if (around > leaf) break;
    meter.spend();
    const Chart::State& outer = chart_.states[around];
    const bool passed_over = run_[around].passed_over && event == nullptr;
    if ((outer.always_count == 0 && !passed_over) || !chart_.inside(leaf, around)) continue;
    for (std::uint16_t i = 0; i < outer.always_count; ++i) {
      const auto number = static_cast<std::uint16_t>(outer.first_always + i);
      meter.spend(transition_steps);
      if (there_already(chart_.transitions[number])) continue;
      if (enabled(state, number, event) && !lets_pass(meter, number, event)) return number;
    }
    const std::uint16_t found = passed_over ? select_passed_over(state, meter, around) : none;
    if (found != none) return found;
  }
  return none;
}

std::uint16_t ChartRunner::select_passed_over(lua_State* state, StepMeter& meter, StateIndex outer) {
  const Chart::State& at = chart_.states[outer];
  for (std::uint16_t i = 0; i < at.transition_count; ++i) {
    meter.spend(transition_steps);
    const auto number = static_cast<std::uint16_t>(at.first_transition + i);
    if (chart_.transitions[number].timed && enabled(state, number, nullptr) && !lets_pass(meter, number, nullptr))
      return number;
  }
  return none;
}

std::uint16_t ChartRunner::select_ordinary(lua_State* state, StepMeter& meter, StateIndex leaf,
                                           const WaitingEvent* event) {
  for (StateIndex inner = leaf; inner != no_state; inner = chart_.states[inner].parent) {
    const Chart::State& at = chart_.states[inner];
    for (std::uint16_t i = 0; i < at.transition_count; ++i) {
      meter.spend(transition_steps);
      const auto number = static_cast<std::uint16_t>(at.first_transition + i);
      if (enabled(state, number, event) && !lets_pass(meter, number, event)) return number;
    }
  }
  return none;
}

bool ChartRunner::there_already(const Chart::Transition& transition) const noexcept {
  if (transition.target == no_state || !run_[transition.target].active) return false;
  return std::ranges::all_of(transition.also, [&](StateIndex target) { return run_[target].active; });
}

// An action alone, without an event that it would use up, is taken beside what else is found.
bool ChartRunner::lets_pass(StepMeter& meter, std::uint16_t number, const WaitingEvent* event) {
  if (chart_.transitions[number].target != no_state || event != nullptr) return false;
  add_selected(meter, number);
  return true;
}

// After the first step's selection: each `after` that is due and is not taken, for what is taken leaves the same
// states. Without this, transitions of inner states could follow each other for ever.
void ChartRunner::note_passed_over(lua_State* state, StepMeter& meter) {
  for (const StateIndex index : active_) {
    const Chart::State& at = chart_.states[index];
    for (std::uint16_t i = 0; i < at.transition_count; ++i) {
      const auto number = static_cast<std::uint16_t>(at.first_transition + i);
      const Chart::Transition& transition = chart_.transitions[number];
      if (!transition.timed || transition.on != no_event || !due(state, number)) continue;
      meter.spend(selected_steps * selected_.size());
      if (std::ranges::find(selected_, number) != selected_.end()) continue;
      for (const std::uint16_t taken : selected_) {
        if (passes_over(taken, number)) run_[index].passed_over = true;
      }
    }
    meter.spend(transition_steps * at.transition_count);
  }
}

// A transition with a target that was found further inside hides an action alone, which conflicts with nothing.
bool ChartRunner::passes_over(std::uint16_t taken, std::uint16_t due) const noexcept {
  const Chart::Transition &one = chart_.transitions[taken], &other = chart_.transitions[due];
  if (other.target != no_state) return conflict(taken, due);
  return one.target != no_state && chart_.inside(one.source, other.source);
}

bool ChartRunner::conflict(std::uint16_t one, std::uint16_t other) const noexcept {
  const StateIndex domain = chart_.transitions[one].domain, its = chart_.transitions[other].domain;
  if (domain == no_state || its == no_state) return false;  // one of them leaves nothing
  return chart_.inside(domain, its) || chart_.inside(its, domain);
}

// Keeps `selected_` free of transitions that leave the same states.
void ChartRunner::add_selected(StepMeter& meter, std::uint16_t added) {
  meter.spend(selected_steps * selected_.size());
  const Chart::Transition& transition = chart_.transitions[added];
  for (const std::uint16_t other : selected_) {
    if (other == added) return;
    const Chart::Transition& earlier = chart_.transitions[other];
    const bool further_inside = transition.source != earlier.source && chart_.inside(transition.source, earlier.source);
    if (conflict(added, other) && !further_inside) return;
  }
  std::erase_if(selected_, [&](std::uint16_t other) { return conflict(added, other); });
  selected_.push_back(added);
}

bool ChartRunner::is_leaf(std::size_t position) const noexcept {
  return position + 1 == active_.size() || !chart_.inside(active_[position + 1], active_[position]);
}

void ChartRunner::select(lua_State* state, const WaitingEvent* event) {
  StepMeter meter(state);
  selected_.clear();
  ++look_;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (!is_leaf(i)) continue;
    const std::uint16_t found = select_always(state, meter, active_[i], event);
    run_[active_[i]].decided = found != none;
    if (found == none) continue;
    add_selected(meter, found);
  }
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (!is_leaf(i) || run_[active_[i]].decided) continue;
    const std::uint16_t found = select_ordinary(state, meter, active_[i], event);
    if (found != none) add_selected(meter, found);
  }
  if (event == nullptr && !selected_.empty()) note_passed_over(state, meter);
  meter.settle();
}

// Not those beside an event: there is none.
void ChartRunner::try_guards(lua_State* state) {
  ++look_;
  for (const StateIndex index : active_) {
    for (const Chart::Transition& one : chart_.transitions_of(chart_.states[index])) {
      if (one.on == no_event || one.on == run_done_event)
        (void)guard(state, static_cast<std::uint16_t>(&one - chart_.transitions.data()));
    }
  }
}

}  // namespace kadans
