// Which transitions a step of a chart takes.
#include <algorithm>

#include <lua.hpp>

#include "chart_runner.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

constexpr std::uint16_t none = 0xffff;
constexpr std::size_t transition_steps = 6, selected_steps = 6;  // to look at one

}  // namespace

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

void ChartRunner::try_guards(lua_State* state) {
  for (const StateIndex index : active_) {
    const Chart::State& at = chart_.states[index];
    for (std::uint16_t i = 0; i < at.transition_count; ++i) {
      (void)guard(state, static_cast<std::uint16_t>(at.first_transition + i));
    }
    for (std::uint16_t i = 0; i < at.always_count; ++i) {
      (void)guard(state, static_cast<std::uint16_t>(at.first_always + i));
    }
  }
}

}  // namespace kadans
