#include "chart_runner.h"

#include <algorithm>

#include <lua.hpp>

#include "script/bindings/bindings.h"
#include "script/lua/lua_core.h"
#include "script/motion/motion.h"
#include "signal/byte_order.h"

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
  bindings_of(state).take_back(index);
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

// Calls into Lua: functions of states, and the coroutines of `run`.

// m.time_s is the time in the state whose function is called.
void ChartRunner::set_time(lua_State* state, StateIndex index) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].content);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.time_key);
  lua_pushnumber(state, state_time_s(index));
  lua_rawset(state, -3);
  lua_pop(state, 1);
}

void ChartRunner::call(lua_State* state, int function, StateIndex index) {
  set_time(state, index);
  bindings_of(state).caller = index;
  core_of(state).called = function;
  lua_rawgeti(state, LUA_REGISTRYINDEX, function);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].handle);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.snapshot);
  lua_call(state, 2, 0);
}

void ChartRunner::start_run(lua_State* state, StateIndex index) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.threads);
  lua_State* thread = lua_newthread(state);
  lua_rawseti(state, -2, index + 1);
  lua_pop(state, 1);
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
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.threads);
  lua_pushnil(state);
  lua_rawseti(state, -2, index + 1);
  lua_pop(state, 1);
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

void ChartRunner::resume_run(lua_State* state, StateIndex index) {
  StateRun& run = run_[index];
  lua_State* thread = run.thread;
  int arguments = 0;
  if (!ready(state, run, thread, arguments)) return;
  set_time(state, index);
  bindings_of(state).caller = index;
  LuaCore& core = core_of(state);
  run.thread_started = true;
  core.called = chart_.states[index].run;
  wait_motion_ = nullptr;
  wait_ns_ = now_ns_;
  core.running = thread;
  const int status = lua_resume(thread, arguments);
  core.running = nullptr;
  if (status == LUA_YIELD) {
    run.motion = wait_motion_;
    run.wake_ns = wait_ns_;
    return;
  }
  if (status != 0) {
    core.budget.raise_again(state);
    const bool text = lua_type(thread, -1) == LUA_TSTRING;
    core.error.set_message(text ? lua_tostring(thread, -1) : "the script raised a value that is not a string");
    if (core.error.line == 0) note_place(thread, core.error);
    luaL_traceback(state, thread, nullptr, 0);
    core.error.set_traceback(lua_tostring(state, -1));
    lua_xmove(thread, state, 1);
    lua_error(state);
  }
  run.run_done = true;
  cancel_run(state, index);
}

// A runner continues where another one stood, of an older version of the chart or of another process. The state of a
// runner is written as bytes and read back. States, events and outcomes are written by their names, because the other
// runner has read the chart's file anew and may have found another version of it. What no longer exists is left out,
// and so is what contradicts itself. A state is the same when its path and its kind are, and both are a machine's root
// or both not.

namespace {

enum Bit : std::uint8_t { bit_active = 1, bit_entering = 2, bit_run_done = 4 };

bool same_kind(const Chart::State& one, const Chart::State& other) noexcept {
  return one.kind == other.kind && one.machine_root == other.machine_root;
}

StateIndex find_state(const Chart& chart, const Chart::State& wanted) {
  const auto found = std::ranges::find(chart.states, wanted.path, &Chart::State::path);
  const bool same = found != chart.states.end() && same_kind(*found, wanted);
  return same ? static_cast<StateIndex>(found - chart.states.begin()) : no_state;
}

std::string_view text_of(ByteReader& bytes) noexcept {
  const auto text = bytes.take_bytes(bytes.take<std::uint32_t>());
  return {reinterpret_cast<const char*>(text.data()), text.size()};
}

void put_state(const Chart::State& state, ByteWriter& bytes) {
  bytes.put_string(state.path);
  bytes.put(static_cast<std::uint8_t>(state.kind));
  bytes.put<std::uint8_t>(state.machine_root);
}

StateIndex take_state(const Chart& chart, ByteReader& bytes) {
  Chart::State wanted;
  wanted.path = bytes.take_string();
  wanted.kind = static_cast<Chart::Kind>(bytes.take<std::uint8_t>());
  wanted.machine_root = bytes.take<std::uint8_t>() != 0;
  return find_state(chart, wanted);
}

}  // namespace

void ChartRunner::keep(ByteWriter& bytes) const {
  const auto put_event = [&](EventId event) {
    bytes.put_string(event == no_event ? std::string_view{} : chart_.events[static_cast<std::size_t>(event)]);
  };
  bytes.put<std::uint8_t>(started_);
  bytes.put<std::uint8_t>(finished_);
  bytes.put<std::uint8_t>(filling_);
  bytes.put(unhandled_);
  const auto told = [](const StateRun& run) { return run.active || run.entering || run.outcome != no_event; };
  bytes.put(static_cast<std::uint32_t>(std::ranges::count_if(run_, told)));
  for (StateIndex i = 0; i < chart_.size(); ++i) {
    const StateRun& run = run_[i];
    if (!told(run)) continue;
    put_state(chart_.states[i], bytes);
    bytes.put(static_cast<std::uint8_t>((run.active ? bit_active : 0) | (run.entering ? bit_entering : 0) |
                                        (run.run_done ? bit_run_done : 0)));
    bytes.put(run.entered_ns);
    put_event(run.outcome);
  }
  keep_histories(bytes);
  bytes.put(event_count_);
  for (std::uint32_t i = 0; i < event_count_; ++i) put_event(events_[(event_first_ + i) % events_.size()]);
}

void ChartRunner::keep_histories(ByteWriter& bytes) const {
  bytes.put(static_cast<std::uint32_t>(std::ranges::count(remembered_, true)));
  for (StateIndex history = 0; history < chart_.size(); ++history) {
    if (!remembered_[history]) continue;
    put_state(chart_.states[history], bytes);
    bytes.put(static_cast<std::uint32_t>(std::ranges::count(histories_[history], true)));
    for (StateIndex i = 0; i < chart_.size(); ++i) {
      if (histories_[history][i]) put_state(chart_.states[i], bytes);
    }
  }
}

bool ChartRunner::restore(ByteReader& bytes) {
  started_ = bytes.take<std::uint8_t>() != 0;
  finished_ = bytes.take<std::uint8_t>() != 0;
  filling_ = bytes.take<std::uint8_t>() != 0;
  unhandled_ = bytes.take<std::uint64_t>();
  std::vector<bool> listed(chart_.states.size(), false);
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    if (!restore_state(bytes, listed)) return false;
  }
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) restore_history(bytes);
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    const EventId event = chart_.find_event(text_of(bytes));
    if (event == no_event || !post(event)) ++unhandled_;
  }
  list_active();
  fill_gaps();
  return bytes.ok() && (active_.empty() == (!started_ || finished_));
}

// In the chart's order: what is around a state came before it. False: the state was listed before. What is in it may be
// active already and rely on it.
bool ChartRunner::restore_state(ByteReader& bytes, std::vector<bool>& listed) {
  const StateIndex index = take_state(chart_, bytes);
  const auto bits = bytes.take<std::uint8_t>();
  const auto entered_ns = bytes.take<std::int64_t>();
  const EventId outcome = chart_.find_event(text_of(bytes));
  if (index == no_state || !bytes.ok()) return true;
  if (listed[index]) return false;
  listed[index] = true;
  const Chart::State& state = chart_.states[index];
  StateRun& run = run_[index];
  run.outcome = outcome;
  run.run_done = (bits & bit_run_done) != 0;
  run.entered_ns = entered_ns;
  if ((bits & (bit_active | bit_entering)) == 0 || state.kind == Chart::Kind::history) return true;
  const auto there = [&](StateIndex i) { return run_[i].active || run_[i].entering; };
  bool alone = true;
  for (StateIndex other = static_cast<StateIndex>(state.parent + 1);
       index != 0 && other < chart_.states[state.parent].end; other = chart_.states[other].end) {
    alone = alone && !there(other);
  }
  const bool fits =
      index == 0 || (there(state.parent) && (alone || chart_.states[state.parent].kind == Chart::Kind::parallel));
  run.active = fits && (bits & bit_active) != 0;
  run.entering = fits && !run.active;
  entering_ = entering_ || run.entering;
  return true;
}

void ChartRunner::restore_history(ByteReader& bytes) {
  const StateIndex history = take_state(chart_, bytes);
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    const StateIndex state = take_state(chart_, bytes);
    if (history == no_state || state == no_state || histories_[history].empty()) continue;
    const StateIndex around = chart_.states[history].parent, its = chart_.states[state].parent;
    if (state == around || !chart_.inside(state, around) || (its != around && !histories_[history][its])) continue;
    histories_[history][state] = remembered_[history] = true;
  }
}

void ChartRunner::start_runs(lua_State* state) {
  for (const StateIndex index : active_) {
    if (chart_.states[index].run != Chart::no_function && !run_[index].run_done) start_run(state, index);
  }
}

// What is active and has states, none of them active: they are entered by default.
void ChartRunner::fill_gaps() noexcept {
  for (const StateIndex index : active_) {
    const Chart::State& around = chart_.states[index];
    const bool parallel = around.kind == Chart::Kind::parallel;
    bool any = false;
    for (StateIndex child = static_cast<StateIndex>(index + 1); child < around.end; child = chart_.states[child].end) {
      const bool there = run_[child].active || run_[child].entering;
      any = any || there;
      if (parallel && !there) fill(index, child);
    }
    if (!parallel && !any && around.initial != no_state) fill(index, around.initial);
  }
}

void ChartRunner::fill(StateIndex around, StateIndex entered) noexcept {
  filling_ = true;
  run_[around].outcome = no_event;
  mark_entry(entered);
}

std::vector<bool> ChartRunner::gone_from(const ChartRunner& other) const {
  std::vector<bool> gone(chart_.states.size(), false);
  for (StateIndex index = 0; index < chart_.size(); ++index) {
    if (!run_[index].active) continue;
    const StateIndex there = find_state(other.chart_, chart_.states[index]);
    gone[index] = there == no_state || !other.run_[there].active;
  }
  return gone;
}

void ChartRunner::report_gone(const ChartRunner& old, const std::vector<bool>& gone) noexcept {
  for (std::size_t i = 0; i < old.active_.size(); ++i) {
    if (!gone[old.active_[i]] || !old.is_leaf(i)) continue;
    StateIndex around = old.active_[i];
    while (gone[around]) around = old.chart_.states[around].parent;
    const StateIndex stays = find_state(chart_, old.chart_.states[around]), initial = chart_.states[stays].initial;
    sink_.transitioned(old.chart_.states[old.active_[i]].path,
                       chart_.states[initial != no_state ? initial : stays].path, "reload");
  }
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

void ChartRunner::leave_marked(lua_State* state, const std::vector<bool>& marks, std::int64_t now_ns) {
  now_ns_ = now_ns;
  for (StateIndex index = chart_.size(); index > 0; --index) {
    const auto i = static_cast<StateIndex>(index - 1);
    if (run_[i].active && marks[i]) leave(state, i);
  }
  list_active();
}

StateIndex ChartRunner::innermost() const noexcept {
  StateIndex at = 0;
  for (const StateIndex index : active_) {
    if (index != 0 && chart_.states[index].parent == at) at = index;
  }
  return at;
}

void ChartRunner::enter_again(const std::vector<bool>& marks) noexcept {
  for (StateIndex i = 0; i < chart_.size(); ++i) {
    if (!marks[i]) continue;
    entering_ = run_[i].entering = true;
    filling_ = true;
  }
}

}  // namespace kadans
