// Errors of a chart's functions as events.
//
// Where a transition of an active state around it waits for "error", a function that raises does not end the behavior.
// What it asked for and emitted is dropped, what it wrote into vars stays, and the step goes on: a guard says no, of a
// state whose `enter` raised nothing inside is entered. Then the error is the event of the next step, before all that
// wait: the innermost state around the function that has a transition for it takes it. When none does after all, the
// error is raised again, and the behavior ends.
//
// A tick recovers from one error. The next one, in the recovery or elsewhere, ends the behavior. So does a breach of
// the budget: what is used up is not there for a recovery.
#include <algorithm>
#include <cstring>

#include <lua.hpp>

#include "chart_runner.h"
#include "script/bindings/bindings.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"

namespace kadans {
namespace {

constexpr double failure_instructions = 500;
constexpr int failure_slot = EventQueue::places + 1;  // in RunnerTables::event_data
constexpr std::int8_t failure_place = EventQueue::places;

void tell_taken(ScriptVoice& voice, const ScriptError& error) noexcept {
  voice.say_with(BehaviorLog::Severity::warning, ("error taken as an event: " + error.text()).c_str());
}

}  // namespace

const char* cause_of(const Chart& chart, StateIndex index, int function) noexcept {
  const Chart::State& state = chart.states[index];
  if (function == state.enter) return "enter";
  if (function == state.exit) return "exit";
  if (function == state.during) return "during";
  if (function == state.run) return "run";
  if (function == state.result) return "result";
  for (const Chart::Transition& transition : chart.transitions) {
    if (function == transition.when && transition.source == index) return "when";
    if (function == transition.action && transition.source == index) return "action";
  }
  return "call";
}

struct ChartRunner::Attempt {
  Bindings::Mark commands;
  std::size_t events = 0;
  int depth = 0, coroutines = 0;
};

bool ChartRunner::waits_for(EventId event) const noexcept {
  return std::ranges::any_of(active_, [&](StateIndex index) {
    return has_transition_for(
        index, [&](const Chart::Transition& one) { return one.on == event || chart_.takes_by_pattern(one, event); });
  });
}

ChartRunner::Attempt ChartRunner::begin_attempt(lua_State* state) const noexcept {
  const LuaCore& core = core_of(state);
  return {bindings_of(state).mark(), queue_.size(), core.depth, core.coroutines};
}

bool ChartRunner::call_recoverably(lua_State* state, StateIndex index, int arguments, int results) {
  if (!recoverable_ || !chart_.takes_errors[index]) return lua_call(state, arguments, results), true;
  const Attempt attempt = begin_attempt(state);
  const int function = lua_gettop(state) - arguments;
  lua_rawgeti(state, LUA_REGISTRYINDEX, core_of(state).handler);
  lua_insert(state, function);
  const int status = lua_pcall(state, arguments, results, function);
  lua_remove(state, function);
  if (status == 0) return true;
  core_of(state).budget.raise_again(state);
  note_failure(state, index, attempt);
  lua_pop(state, 1);
  return false;
}

// As lua_resume; -1: the error is going to be an event.
int ChartRunner::resume_recoverably(lua_State* state, StateIndex index, int arguments) {
  const Attempt attempt = begin_attempt(state);
  lua_State* thread = run_[index].thread;
  const int status = lua_resume(thread, arguments);
  if (status == 0 || status == LUA_YIELD || !chart_.takes_errors[index]) return status;
  core_of(state).running = nullptr;
  core_of(state).budget.raise_again(state);
  keep_run_error(state, thread);
  note_failure(state, index, attempt);
  cancel_run(state, index);
  run_[index].stopped = true;
  return -1;
}

// The error is in LuaCore::error.
void ChartRunner::note_failure(lua_State* state, StateIndex index, const Attempt& attempt) {
  LuaCore& core = core_of(state);
  core.depth = attempt.depth;
  core.coroutines = attempt.coroutines;
  bindings_of(state).take_back_to(attempt.commands);
  queue_.shrink(attempt.events);
  recoverable_ = false;
  failed_ = true;
  failed_in_ = index;
  failure_ = core.error;
  core.error.clear();
  core.budget.charge(state, failure_instructions);
  lua_createtable(state, 0, 5);
  set_field(state, "message", failure_.message.data());
  set_field(state, "file", failure_.file.data());
  set_field(state, "line", failure_.line);
  set_field(state, "cause", cause_of(chart_, index, core.called));
  set_field(state, "state", chart_.states[index].path.c_str());
  set_entry(state, tables_.event_data, failure_slot);
}

// [-1 +0] The text at the top, with its place, is an error in this state.
void ChartRunner::fail(lua_State* state, StateIndex index) {
  if (!recoverable_ || !chart_.takes_errors[index]) lua_error(state);
  core_of(state).error.clear();
  core_of(state).error.set_message(lua_tostring(state, -1));
  note_failure(state, index, begin_attempt(state));
  lua_pop(state, 1);
}

// Takes the step for the error.
void ChartRunner::recover(lua_State* state) {
  failed_ = false;
  const WaitingEvent event{.id = chart_.error_event, .from = failed_in_, .place = failure_place};
  show_event(state, event);
  select(state, &event);
  if (selected_.empty()) {
    core_of(state).error = failure_;
    lua_pushstring(state, failure_.message.data());
    lua_error(state);
  }
  tell_taken(voice_, failure_);
  take_step(state);
  forget_data(state, event);
}

// The same for an error of `during` and `run`, behind all steps. What they emitted waits for the next tick.
void ChartRunner::recover_late(lua_State* state) {
  recover(state);
  for (std::uint32_t steps = 1; run_[0].outcome == no_event && steps < steps_max; ++steps) {
    if (!select_event(state, true)) break;
    take_step(state);
  }
  for (std::size_t i = queue_.size(); i > 0; --i) {
    if (queue_[i - 1].from != no_state) queue_.remove(i - 1);
  }
  hide_event(state);
  if (run_[0].outcome != no_event) stop(state, now_ns_);
}

// Nothing of what is inside is entered.
void ChartRunner::enter_no_further(StateIndex index) noexcept {
  run_[index].stopped = true;
  for (StateIndex i = index; i < chart_.states[index].end; ++i) run_[i].entering = false;
}

}  // namespace kadans
