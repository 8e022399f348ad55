// A runner continues where another one stood, of an older version of the chart or of another process. The state of a
// runner is written as bytes and read back. States, events and outcomes are written by their names, because the other
// runner has read the chart's file anew and may have found another version of it. What no longer exists is left out,
// and so is what contradicts itself. A state is the same when its path and its kind are, and both are a machine's root
// or both not.
#include <algorithm>

#include <lua.hpp>

#include "chart_runner.h"
#include "kadans/signal/state_hash.h"
#include "script/lua/lua_state.h"
#include "signal/byte_order.h"

namespace kadans {
namespace {

enum Bit : std::uint8_t { bit_active = 1, bit_entering = 2, bit_run_done = 4, bit_passed_over = 8, bit_stopped = 16 };

bool same_kind(const Chart::State& one, const Chart::State& other) noexcept {
  return one.kind == other.kind && one.machine_root == other.machine_root;
}

StateIndex find_state(const Chart& chart, const Chart::State& wanted) {
  const auto found = std::ranges::find(chart.states, wanted.path, &Chart::State::path);
  const bool same = found != chart.states.end() && same_kind(*found, wanted);
  return same ? static_cast<StateIndex>(found - chart.states.begin()) : no_state;
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

struct OnceInState {
  std::uint16_t place = 0;  // among the state's own transitions
  std::uint8_t kind = 0;
  std::uint64_t identity = 0;
};

std::uint64_t identity_of(const Chart& chart, const Chart::Transition& transition, std::uint8_t kind) noexcept {
  StateHash hash;
  hash.add(kind);
  hash.add(transition.on == no_event ? std::string_view{} : chart.events[static_cast<std::size_t>(transition.on)]);
  hash.add(transition.after_name);
  hash.add(transition.after_s);
  hash.add(transition.why);
  return hash.value();
}

// Of some that are the same each has an identity of its own, by their order.
std::vector<OnceInState> once_in(const Chart& chart, const Chart::State& state) {
  std::vector<OnceInState> all;
  for (std::uint16_t place = 0; place < state.transition_count + state.always_count; ++place) {
    const auto number = static_cast<std::size_t>(state.first_transition) + place;
    const Chart::Transition& transition = chart.transitions[number];
    if (!transition.once) continue;
    const bool always = number >= state.first_always && number - state.first_always < state.always_count;
    OnceInState one{.place = place,
                    .kind = static_cast<std::uint8_t>((always ? 1 : 0) | (transition.timed ? 2 : 0) |
                                                      (transition.on != no_event ? 4 : 0))};
    one.identity = identity_of(chart, transition, one.kind);
    while (std::ranges::find(all, one.identity, &OnceInState::identity) != all.end()) ++one.identity;
    all.push_back(one);
  }
  return all;
}

}  // namespace

void ChartRunner::keep(ByteWriter& bytes) const {
  const auto put_event = [&](EventId event) {
    bytes.put_string(event == no_event ? std::string_view{} : chart_.events[static_cast<std::size_t>(event)]);
  };
  bytes.put<std::uint8_t>(started_);
  bytes.put<std::uint8_t>(finished_);
  bytes.put<std::uint8_t>(filling_);
  bytes.put<std::uint8_t>(finished_by_ != no_state);
  if (finished_by_ != no_state) put_state(chart_.states[finished_by_], bytes);
  bytes.put(unhandled_);
  const auto told = [](const StateRun& run) { return run.active || run.entering || run.outcome != no_event; };
  bytes.put(static_cast<std::uint32_t>(std::ranges::count_if(run_, told)));
  for (StateIndex i = 0; i < chart_.size(); ++i) {
    const StateRun& run = run_[i];
    if (!told(run)) continue;
    put_state(chart_.states[i], bytes);
    bytes.put(static_cast<std::uint8_t>((run.active ? bit_active : 0) | (run.entering ? bit_entering : 0) |
                                        (run.run_done ? bit_run_done : 0) | (run.passed_over ? bit_passed_over : 0) |
                                        (run.stopped ? bit_stopped : 0)));
    bytes.put(run.entered_ns);
    put_event(run.outcome);
    keep_acted(chart_.states[i], bytes);
  }
  keep_histories(bytes);
  bytes.put(static_cast<std::uint32_t>(queue_.size()));
  for (std::size_t i = 0; i < queue_.size(); ++i) {  // between ticks no end of a state waits
    put_event(queue_[i].id);
    bytes.put(queue_[i].place);
  }
}

// A state's transitions that come once, each with whether it came. Another version may have written them in another
// order: a transition is the same when what it waits for and its word for the log are. One that is in the old version
// alone is taken for the one at its place, when that is in the new version alone and of the same kind: its time or its
// word was changed.
void ChartRunner::keep_acted(const Chart::State& state, ByteWriter& bytes) const {
  const std::vector<OnceInState> all = once_in(chart_, state);
  bytes.put(static_cast<std::uint16_t>(all.size()));
  for (const OnceInState& one : all) {
    bytes.put(one.place);
    bytes.put(one.kind);
    bytes.put(one.identity);
    bytes.put<std::uint8_t>(acted(static_cast<std::uint16_t>(state.first_transition + one.place)));
  }
}

void ChartRunner::restore_acted(StateIndex index, ByteReader& bytes) {
  std::vector<OnceInState> here;
  if (index != no_state) here = once_in(chart_, chart_.states[index]);
  const auto came = [&](const OnceInState& one) {
    guards_[static_cast<std::size_t>(chart_.states[index].first_transition) + one.place].acted_ns =
        run_[index].entered_ns;
  };
  std::vector<OnceInState> changed;  // and came
  for (auto left = bytes.take<std::uint16_t>(); left > 0 && bytes.ok(); --left) {
    OnceInState one{.place = bytes.take<std::uint16_t>(), .kind = bytes.take<std::uint8_t>()};
    one.identity = bytes.take<std::uint64_t>();
    const bool it_came = bytes.take<std::uint8_t>() != 0;
    const auto same = std::ranges::find(here, one.identity, &OnceInState::identity);
    if (same == here.end() && it_came) changed.push_back(one);
    if (same == here.end()) continue;
    if (it_came) came(*same);
    here.erase(same);
  }
  for (const OnceInState& one : changed) {
    const auto same = std::ranges::find(here, one.place, &OnceInState::place);
    if (same != here.end() && same->kind == one.kind) came(*same);
  }
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
  if (bytes.take<std::uint8_t>() != 0) finished_by_ = take_state(chart_, bytes);
  unhandled_ = bytes.take<std::uint64_t>();
  std::vector<bool> listed(chart_.states.size(), false);
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    if (!restore_state(bytes, listed)) return false;
  }
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) restore_history(bytes);
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    const EventId event = chart_.find_or_learn(bytes.take_text());
    const auto place = bytes.take<std::int8_t>();
    if (event == no_event || chart_.made_by_runner(event) || !queue_.send(event, place)) ++unhandled_;
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
  const EventId outcome = chart_.find_event(bytes.take_text());
  if (index != no_state) {
    if (listed[index]) return false;
    listed[index] = true;
    run_[index].entered_ns = entered_ns;
  }
  restore_acted(index, bytes);
  if (index == no_state || !bytes.ok()) return true;
  const Chart::State& state = chart_.states[index];
  StateRun& run = run_[index];
  run.outcome = outcome;
  run.run_done = (bits & bit_run_done) != 0;
  run.passed_over = (bits & bit_passed_over) != 0;
  run.stopped = (bits & bit_stopped) != 0;
  if ((bits & (bit_active | bit_entering)) == 0 || state.kind == Chart::Kind::history) return true;
  const auto there = [&](StateIndex i) { return run_[i].active || run_[i].entering; };
  bool alone = true;
  if (index != 0) chart_.each_child(state.parent, [&](StateIndex other) { alone = alone && !there(other); });
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
    bool alone = true;
    chart_.each_child(its, [&](StateIndex other) { alone = alone && (other == state || !histories_[history][other]); });
    if (!alone && chart_.states[its].kind != Chart::Kind::parallel) continue;
    histories_[history][state] = remembered_[history] = true;
  }
}

void ChartRunner::start_runs(lua_State* state) {
  for (const StateIndex index : active_) {
    const bool goes_on = !run_[index].run_done && !run_[index].stopped;
    if (chart_.states[index].run != Chart::no_function && goes_on) start_run(state, index);
  }
}

// What is active and has states, none of them active: they are entered by default.
void ChartRunner::fill_gaps() noexcept {
  for (const StateIndex index : active_) {
    if (run_[index].stopped) continue;
    const Chart::State& around = chart_.states[index];
    const bool parallel = around.kind == Chart::Kind::parallel;
    bool any = false;
    chart_.each_child(index, [&](StateIndex child) {
      const bool there = run_[child].active || run_[child].entering;
      any = any || there;
      if (parallel && !there && chart_.states[child].kind == Chart::Kind::region) fill(index, child);
    });
    if (!parallel && !any && !around.defaults.empty()) fill(index, no_state);
  }
}

// Enters this state, or what is entered by default.
void ChartRunner::fill(StateIndex around, StateIndex entered) noexcept {
  filling_ = true;
  run_[around].outcome = no_event;
  if (entered != no_state) return mark_entry(entered);
  mark_defaults(around, around);
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
    voice_.transitioned(old.chart_.states[old.active_[i]].path,
                        chart_.states[initial != no_state ? initial : stays].path, "reload");
  }
}

void ChartRunner::leave_marked(lua_State* state, const std::vector<bool>& marks, std::int64_t now_ns) {
  now_ns_ = now_ns;
  recoverable_ = failed_ = false;
  for (StateIndex index = chart_.size(); index > 0; --index) {
    const auto i = static_cast<StateIndex>(index - 1);
    if (run_[i].active && marks[i]) leave(state, i);
  }
  list_active();
}

void ChartRunner::enter_again(const std::vector<bool>& marks) noexcept {
  for (StateIndex i = 0; i < chart_.size(); ++i) {
    if (!marks[i]) continue;
    entering_ = run_[i].entering = true;
    filling_ = true;
  }
}

}  // namespace kadans
