#include "chart_runner.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include <lua.hpp>

#include "script/bindings/bindings.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"
#include "script/motion/motion.h"
#include "signal/byte_order.h"

namespace kadans {
namespace {

constexpr std::size_t state_steps = 2;              // to look at a state for one transition
constexpr int shown_slot = EventQueue::places + 2;  // in RunnerTables::event_data

// What is told once.
[[gnu::format(printf, 2, 3)]] void warn(ScriptVoice& voice, const char* pattern, ...) noexcept {
  char text[640];
  std::va_list values;
  va_start(values, pattern);
  std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  voice.say_with(BehaviorLog::Severity::warning, text);
}

}  // namespace

ChartRunner::ChartRunner(Chart& chart, const RunnerTables& tables, ScriptVoice& voice)
    : chart_(chart),
      tables_(tables),
      voice_(voice),
      run_(chart.states.size()),
      guards_(chart.transitions.size()),
      histories_(chart.states.size()),
      remembered_(chart.states.size(), false),
      queue_(chart.states.size()),
      told_(chart.events.size() + Chart::late_events_max, false) {
  active_.reserve(chart.states.size());
  selected_.reserve(chart.transitions.size() + 1);
  for (std::size_t i = 0; i < chart.states.size(); ++i) {
    if (chart.states[i].kind == Chart::Kind::history) histories_[i].assign(chart.states.size(), false);
  }
}

void ChartRunner::tick(lua_State* state, std::int64_t now_ns) {
  before_ns_ = now_ns_;
  now_ns_ = now_ns;
  if (finished_) return;
  if (chart_.error_event != no_event) recoverable_ = true;
  first_step(state);
  std::uint32_t steps = 1;
  for (; (failed_ || run_[0].outcome == no_event) && steps < steps_max; ++steps) {
    if (failed_) {
      recover(state);
      continue;
    }
    if (queue_.size() > 0 && select_event(state)) {
      take_step(state);
      forget_data(state, shown_);
    } else if (!failed_) {
      break;
    }
  }
  if (failed_) recover(state);
  if (shown_.id != no_event) hide_event(state);
  if (run_[0].outcome != no_event) return stop(state, now_ns);
  if (queue_.size() > 0) drop_events(state, steps);
  for (const StateIndex index : active_) {
    if (chart_.states[index].during != Chart::no_function) call(state, chart_.states[index].during, index);
  }
  for (const StateIndex index : active_) {
    if (run_[index].thread != nullptr) resume_run(state, index);
  }
  if (failed_) recover_late(state);
}

void ChartRunner::first_step(lua_State* state) {
  selected_.clear();
  if (!started_) {
    started_ = true;
    mark_entry(0);
  } else if (filling_) {
    filling_ = false;
  } else {
    select(state, nullptr);
  }
  take_step(state);
}

// Takes the oldest event out of the queue for which there is a transition. False: there is none.
bool ChartRunner::select_event(lua_State* state, bool ends_only) {
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const WaitingEvent event = queue_[i];
    if (ends_only && event.from == no_state) continue;
    show_event(state, event);
    select(state, &event);
    if (selected_.empty() && failed_) return false;  // a guard's error comes before all that wait
    if (selected_.empty()) continue;
    queue_.remove(i);
    return true;
  }
  return false;
}

bool ChartRunner::post_with_data(lua_State* state, EventId event) {
  const std::int8_t place = queue_.free_place();
  const bool posted = queue_.send(event, place);
  if (posted) {
    set_entry(state, tables_.event_data, place + 1);
  } else {
    lua_pop(state, 1);
  }
  return posted;
}

// s.event: name and data of the event whose transitions are looked at, or taken. Each function gets a copy of the data
// when it reads it first, so that what it writes there is its own: no other function, region or record sees it.
void ChartRunner::show_event(lua_State* state, const WaitingEvent& event) {
  forget_copy(state);
  shown_ = event;
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.event);
  lua_pushliteral(state, "name");
  push_event_name(state, event.id);
  lua_rawset(state, -3);
  lua_pop(state, 1);
  if (event.place >= 0) {
    push_entry(state, tables_.event_data, event.place + 1);
  } else if (event.from != no_state && chart_.states[event.from].kind == Chart::Kind::parallel) {
    push_outcomes(state, event.from);
  } else if (event.from != no_state && push_result_of(state, final_in(event.from))) {
    lua_createtable(state, 0, 1);
    lua_insert(state, -2);
    lua_setfield(state, -2, "result");
  } else {
    lua_pushnil(state);
  }
  set_entry(state, tables_.event_data, shown_slot);
}

void ChartRunner::push_shown_data(lua_State* state) {
  if (shown_.id == no_event) return lua_pushnil(state);
  push_entry(state, tables_.event_data, shown_slot);
  if (lua_isnil(state, -1)) return;
  push_plain_copy(state, lua_gettop(state));
  lua_remove(state, -2);
  data_copied_ = true;
}

void ChartRunner::forget_copy(lua_State* state) {
  if (!data_copied_) return;
  data_copied_ = false;
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.event);
  lua_pushliteral(state, "data");
  lua_pushnil(state);
  lua_rawset(state, -3);
  lua_pop(state, 1);
}

// [-0 +1] A name that was learnt is not in the table yet.
void ChartRunner::push_event_name(lua_State* state, EventId event) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.event_names);
  lua_rawgeti(state, -1, event + 1);
  if (lua_isnil(state, -1)) {
    lua_pop(state, 1);
    lua_pushstring(state, chart_.events[static_cast<std::size_t>(event)].c_str());
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, event + 1);
  }
  lua_remove(state, -2);
}

void ChartRunner::hide_event(lua_State* state) {
  forget_copy(state);
  shown_ = {};
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.event);
  lua_pushliteral(state, "name");
  lua_pushnil(state);
  lua_rawset(state, -3);
  lua_pop(state, 1);
  lua_pushnil(state);
  set_entry(state, tables_.event_data, shown_slot);
}

// [-0 +1] { outcomes = { region = "done" }, results = { region = { ... } } }
void ChartRunner::push_outcomes(lua_State* state, StateIndex parallel) {
  lua_createtable(state, 0, 2);
  lua_createtable(state, 0, 4);
  lua_createtable(state, 0, 4);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.event_names);
  chart_.each_region(parallel, [&](StateIndex region) {
    lua_pushstring(state, chart_.states[region].name.c_str());
    lua_rawgeti(state, -2, run_[region].outcome + 1);
    lua_rawset(state, -4);
    if (push_result_of(state, final_in(region))) lua_setfield(state, -4, chart_.states[region].name.c_str());
  });
  lua_pop(state, 1);
  lua_setfield(state, -3, "outcomes");
  lua_setfield(state, -2, "results");
}

void ChartRunner::forget_data(lua_State* state, const WaitingEvent& event) {
  if (event.place < 0) return;
  queue_.free(event);
  lua_pushnil(state);
  set_entry(state, tables_.event_data, event.place + 1);
}

void ChartRunner::drop_events(lua_State* state, std::uint32_t steps) {
  for (std::size_t i = 0; i < queue_.size(); ++i) unhandled_ += chart_.is_report(queue_[i].id) ? 0 : 1;
  if (steps == steps_max && !told_steps_) {
    const Chart::Transition& last = chart_.transitions[selected_.front()];
    warn(voice_,
         "%.300s:%d: a tick took all %u steps, the last one by the transition here; further events were dropped. "
         "Do events lead to each other? (told once)",
         chart_.states[last.source].chunk.c_str(), last.line, steps_max);
    told_steps_ = true;
  }
  for (std::size_t i = 0; i < queue_.size() && steps < steps_max; ++i) {
    const auto id = static_cast<std::size_t>(queue_[i].id);
    if (!told_[id] && !chart_.is_report(queue_[i].id))
      warn(voice_, "event '%.200s' was dropped: no transition took it in its tick (told once)",
           chart_.events[id].c_str());
    told_[id] = true;
  }
  for (std::size_t i = 0; i < queue_.size(); ++i) forget_data(state, queue_[i]);
  queue_.clear();
}

void ChartRunner::stop(lua_State* state, std::int64_t now_ns) {
  now_ns_ = now_ns;
  finished_ = true;
  recoverable_ = failed_ = false;
  if (run_[0].outcome != no_event && finished_by_ == no_state) finished_by_ = final_in(0);
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
  std::size_t targets = selected_.size();
  for (const std::uint16_t number : selected_) targets += chart_.transitions[number].also.size();
  meter.spend(state_steps * targets * (active_.size() + chart_.size()));
  meter.settle();
  const SetMask sets_before = bindings_of(state).all_sets != 0 ? sets_asked() : 0;
  for (const std::uint16_t number : selected_) report(state, number);
  for (const StateIndex index : active_) {
    for (const std::uint16_t number : selected_) {
      const StateIndex domain = chart_.transitions[number].domain;
      if (domain != no_state && index != domain && chart_.inside(index, domain)) run_[index].leaving = true;
    }
  }
  for (const StateIndex index : active_) {
    if (run_[index].leaving) remember(index);
  }
  for (std::size_t i = active_.size(); i > 0; --i) {
    if (run_[active_[i - 1]].leaving) leave(state, active_[i - 1]);
  }
  for (const std::uint16_t number : selected_) act(state, number);
  for (const std::uint16_t number : selected_) mark_targets(chart_.transitions[number]);
  entering_ = false;
  if (Bindings& bindings = bindings_of(state); bindings.all_sets != 0) {
    const SetMask sets = sets_asked();
    bindings.want(sets, (sets & ~sets_before) | sets_asked(Asking::entering));
  }
  for (StateIndex index = 0; index < chart_.size(); ++index) {
    if (!run_[index].entering) continue;
    run_[index].entering = false;
    if (!run_[index].active) enter(state, index);
  }
  list_active();
  Bindings& bindings = bindings_of(state);
  if (failed_ && bindings.all_sets != 0) bindings.want(sets_asked(), sets_asked());  // not all of them was entered
}

void ChartRunner::act(lua_State* state, std::uint16_t number) {
  const Chart::Transition& transition = chart_.transitions[number];
  if (transition.once) guards_[number].acted_ns = run_[transition.source].entered_ns;
  if (transition.action != Chart::no_function) call(state, transition.action, transition.source);
}

void ChartRunner::leave(lua_State* state, StateIndex index) {
  StateRun& run = run_[index];
  run.active = false;
  run.leaving = false;
  run.outcome = index == 0 ? run.outcome : no_event;
  queue_.withdraw(index);
  if (chart_.states[index].kind == Chart::Kind::final_state) go_on(chart_.states[index].parent);
  cancel_run(state, index);
  bindings_of(state).take_back(index);
  if (chart_.states[index].exit != Chart::no_function) call(state, chart_.states[index].exit, index);
}

void ChartRunner::enter(lua_State* state, StateIndex index) {
  const Chart::State& entered = chart_.states[index];
  StateRun& run = run_[index];
  run.active = true;
  run.run_done = run.passed_over = run.stopped = false;
  run.outcome = no_event;
  run.entered_ns = now_ns_;
  if (entered.machine_root) {  // a call begins anew: nothing is left of the one before
    renew_machine(state, chart_, tables_, entered.machine);
    for (StateIndex i = index; i < entered.end; ++i) remembered_[i] = false;
    if (!evaluate_call(state, entered.machine)) return enter_no_further(index);
  }
  if (entered.enter != Chart::no_function && !call(state, entered.enter, index)) return enter_no_further(index);
  if (entered.run != Chart::no_function) start_run(state, index);
  if (entered.kind == Chart::Kind::final_state && make_result(state, index)) complete(entered.parent, entered.outcome);
}

// `index` came to an end with this outcome; so did, perhaps, what is around it.
void ChartRunner::complete(StateIndex index, EventId outcome) noexcept {
  run_[index].outcome = outcome;
  const Chart::State& ended = chart_.states[index];
  if (index == 0) return;
  if (ended.machine_root) return complete(ended.parent, outcome);
  if (waits_for_end(index, outcome)) queue_.end(index, outcome);
  if (ended.kind != Chart::Kind::region) return;
  EventId together = no_event;  // the first outcome that is not "done", else "done"
  bool all = true;
  chart_.each_region(ended.parent, [&](StateIndex region) {
    const EventId its = run_[region].outcome;
    all = all && its != no_event;
    if (together == no_event || together == done_event) together = its;
  });
  if (all) complete(ended.parent, together);
}

// The opposite: a final state of `index` is left while what is around it stays.
void ChartRunner::go_on(StateIndex index) noexcept {
  if (index == 0) {
    if (!finished_) run_[0].outcome = no_event;
    return;
  }
  run_[index].outcome = no_event;
  queue_.withdraw(index);
  const Chart::State& ended = chart_.states[index];
  if (ended.machine_root) return go_on(ended.parent);
  if (ended.kind == Chart::Kind::region) go_on(ended.parent);
}

// Whether a transition somewhere has this event: an end that nobody waits for is none.
bool ChartRunner::waits_for_end(StateIndex ended, EventId outcome) const noexcept {
  for (StateIndex index = ended;; index = chart_.states[index].parent) {
    const Chart::State& at = chart_.states[index];
    if (has_transition_for(index, [&](const Chart::Transition& one) { return one.on == outcome; })) return true;
    if (at.kind == Chart::Kind::region || at.machine_root) return false;
  }
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
    chart_.each_region(target, [&](StateIndex region) {
      if (!run_[region].entering) mark_entry(region);
    });
  } else {
    mark_defaults(target, target);
  }
}

// SCXML, computeEntrySet: all targets with what is in them, then what is around them.
void ChartRunner::mark_targets(const Chart::Transition& transition) noexcept {
  transition.each_target([&](StateIndex target) { mark_entry(target); });
  transition.each_target([&](StateIndex target) { mark_ancestors(target, transition.domain); });
}

void ChartRunner::mark_defaults(StateIndex index, StateIndex around) noexcept {
  for (const StateIndex target : chart_.states[index].defaults) mark_entry(target);
  for (const StateIndex target : chart_.states[index].defaults) mark_ancestors(target, around);
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
  if (!remembered_[history]) return mark_defaults(history, parent);
  const bool deep = chart_.states[history].deep;
  const std::vector<bool>& remembered = histories_[history];
  StateIndex next = chart_.states[parent].end;  // of the remembered states the one behind in document order
  for (StateIndex index = next; index > parent + 1; --index) {
    const auto i = static_cast<StateIndex>(index - 1);
    if (!remembered[i] || chart_.states[i].machine != chart_.states[history].machine) continue;  // a call begins anew
    if (deep ? next >= chart_.states[i].end : chart_.states[i].parent == parent) mark_entry(i);
    next = i;
  }
  for (StateIndex i = static_cast<StateIndex>(parent + 1); deep && i < chart_.states[parent].end; ++i) {
    if (!remembered[i] || chart_.states[i].machine != chart_.states[history].machine) continue;
    run_[i].entering = true;
    if (chart_.states[i].kind == Chart::Kind::parallel) mark_entry(i);  // a reload may have brought further regions
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
void ChartRunner::report(lua_State* state, std::uint16_t number) noexcept {
  const Chart::Transition& transition = chart_.transitions[number];
  if (transition.target == no_state) return;
  StateIndex from = transition.source;
  for (const StateIndex index : active_) {
    if (chart_.states[index].parent == from) from = index;
  }
  voice_.transitioned(chart_.states[from].path, chart_.states[transition.target].path, transition.why);
  if (shown_.id == no_event) note_restless(state, transition, from);
}

// A state that was entered in the tick before and is left by a transition without an event and without time to wait.
// With an event it may be right: somebody sends one in each tick.
void ChartRunner::note_restless(lua_State* state, const Chart::Transition& transition, StateIndex from) noexcept {
  if (transition.timed && after_s(state, transition) > 0) return;
  std::uint32_t ticks = 0;
  for (StateIndex index = from; index != transition.domain; index = chart_.states[index].parent) {
    const StateRun& run = run_[index];
    if (run.entered_ns == before_ns_) ticks = std::max(ticks, run.restless_ns == before_ns_ ? run.restless + 1 : 1);
  }
  const bool by_history = chart_.states[transition.target].kind == Chart::Kind::history;
  StateRun& entered = run_[by_history ? chart_.states[transition.target].parent : transition.target];
  entered.restless = ticks;
  entered.restless_ns = now_ns_;
  if (ticks < restless_ticks || told_restless_) return;
  told_restless_ = true;
  warn(voice_,
       "%.200s:%d: for %u ticks a state followed another at once, now '%.80s' after '%.80s': nothing takes "
       "time. Should one wait, for a condition, an event or after > 0? (told once)",
       chart_.states[from].chunk.c_str(), transition.line, ticks, chart_.states[transition.target].path.c_str(),
       chart_.states[from].path.c_str());
}

StateIndex ChartRunner::innermost(StateIndex around) const noexcept {
  StateIndex at = around;
  for (const StateIndex index : active_) {
    if (index != 0 && chart_.states[index].parent == at) at = index;
  }
  return at;
}

SetMask ChartRunner::sets_asked(Asking asking) const noexcept {
  SetMask asked = 0;
  StateIndex next = chart_.size();  // the next active state in document order
  for (StateIndex index = chart_.size(); index > 0; --index) {
    const auto i = static_cast<StateIndex>(index - 1);
    if (!run_[i].active && !run_[i].entering) continue;
    const bool counts = asking == Asking::all || !run_[i].active;
    if (next >= chart_.states[i].end && counts) asked |= chart_.states[i].sets;  // nothing in it is active
    next = i;
  }
  return asked;
}

double ChartRunner::state_time_s(StateIndex state) const noexcept {
  return static_cast<double>(now_ns_ - run_[state].entered_ns) / 1e9;
}

// Calls into Lua: functions of states, and the coroutines of `run`.

// m.time_s is the time in the state whose function is called.
void ChartRunner::set_time(lua_State* state, StateIndex index) {
  acting_ = index;
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].content);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.time_key);
  lua_pushnumber(state, state_time_s(index));
  lua_rawset(state, -3);
  lua_pop(state, 1);
}

void ChartRunner::push_call(lua_State* state, int function, StateIndex index) {
  forget_copy(state);
  set_time(state, index);
  core_of(state).called = function;
  lua_rawgeti(state, LUA_REGISTRYINDEX, function);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].handle);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.snapshot);
}

bool ChartRunner::call(lua_State* state, int function, StateIndex index) {
  push_call(state, function, index);
  return call_recoverably(state, index, 2, 0);
}

void ChartRunner::start_run(lua_State* state, StateIndex index) {
  lua_State* thread = lua_newthread(state);
  set_entry(state, tables_.threads, index + 1);
  lua_rawgeti(state, LUA_REGISTRYINDEX, chart_.states[index].run);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].handle);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.snapshot);
  lua_xmove(state, thread, 3);
  StateRun& run = run_[index];
  run.thread = thread;
  run.thread_started = false;
  run.motion = nullptr;
  run.wake_ns = now_ns_;
}

void ChartRunner::cancel_run(lua_State* state, StateIndex index) {
  StateRun& run = run_[index];
  if (run.thread == nullptr) return;
  run.thread = nullptr;
  run.motion = nullptr;
  lua_pushnil(state);
  set_entry(state, tables_.threads, index + 1);
}

// Whether what the coroutine waits for is over; pushes what its wait() returns.
bool ChartRunner::ready(lua_State* state, StateRun& run, lua_State* thread, int& arguments) const noexcept {
  if (!run.thread_started) return arguments = 2, true;
  if (run.motion != nullptr) {
    const Bindings& bindings = bindings_of(state);
    observe(*run.motion, *bindings.snapshot, now_ns_);
    if (!run.motion->over()) return false;
    const char* why = failure(*run.motion);
    lua_settop(thread, 0);
    const bool refused = run.motion->state == MotionState::refused;
    arguments = why == nullptr ? 1 : refused ? 3 : 2;
    if (why == nullptr) return lua_pushboolean(thread, 1), true;
    lua_pushnil(thread);
    lua_pushstring(thread, why);
    if (refused) push_reason(thread, *run.motion);
    return true;
  }
  if (now_ns_ < run.wake_ns) return false;
  lua_settop(thread, 0);
  return arguments = 0, true;
}

// Keeps the error at the top of the coroutine's stack.
void ChartRunner::keep_run_error(lua_State* state, lua_State* thread) {
  ScriptError& error = core_of(state).error;
  const bool text = lua_type(thread, -1) == LUA_TSTRING;
  error.set_message(text ? lua_tostring(thread, -1) : "the script raised a value that is not a string");
  if (error.line == 0) note_place(thread, error);
  luaL_traceback(state, thread, nullptr, 0);
  error.set_traceback(lua_tostring(state, -1));
  lua_pop(state, 1);
  if (LineWatch* watch = core_of(state).budget.watch()) watch->raised(thread, error.message.data());
}

void ChartRunner::resume_run(lua_State* state, StateIndex index) {
  StateRun& run = run_[index];
  lua_State* thread = run.thread;
  int arguments = 0;
  if (!ready(state, run, thread, arguments)) return;
  set_time(state, index);
  LuaCore& core = core_of(state);
  run.thread_started = true;
  core.called = chart_.states[index].run;
  wait_motion_ = nullptr;
  wait_ns_ = now_ns_;
  core.running = thread;
  const int status = recoverable_ ? resume_recoverably(state, index, arguments) : lua_resume(thread, arguments);
  core.running = nullptr;
  if (status < 0) return;
  if (status == LUA_YIELD) {
    run.motion = wait_motion_;
    run.wake_ns = wait_ns_;
    return;
  }
  if (status != 0) {
    core.budget.raise_again(state);
    keep_run_error(state, thread);
    lua_xmove(thread, state, 1);
    lua_error(state);
  }
  run.run_done = true;
  cancel_run(state, index);
}

}  // namespace kadans
