// How a runner continues where another one stood, of another process or of an older version of the chart.
//
// For another process, the state of a runner is written as bytes and read back. States, events and outcomes are written
// by their names, because that process reads the chart's file anew and may find another version of it. What no longer
// exists is left out, and so is what contradicts itself.

#include <algorithm>

#include <lua.hpp>

#include "chart_runner.h"
#include "signal/byte_order.h"

namespace kadans {
namespace {

enum Bit : std::uint8_t { bit_active = 1, bit_entering = 2, bit_run_done = 4 };

StateIndex find_state(const Chart& chart, std::string_view path) {
  const auto found = std::ranges::find(chart.states, path, &Chart::State::path);
  return found == chart.states.end() ? no_state : static_cast<StateIndex>(found - chart.states.begin());
}

std::string_view text_of(ByteReader& bytes) noexcept {
  const auto text = bytes.take_bytes(bytes.take<std::uint32_t>());
  return {reinterpret_cast<const char*>(text.data()), text.size()};
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
    bytes.put_string(chart_.states[i].path);
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
    bytes.put_string(chart_.states[history].path);
    bytes.put(static_cast<std::uint32_t>(std::ranges::count(histories_[history], true)));
    for (StateIndex i = 0; i < chart_.size(); ++i) {
      if (histories_[history][i]) bytes.put_string(chart_.states[i].path);
    }
  }
}

bool ChartRunner::restore(ByteReader& bytes) {
  started_ = bytes.take<std::uint8_t>() != 0;
  finished_ = bytes.take<std::uint8_t>() != 0;
  filling_ = bytes.take<std::uint8_t>() != 0;
  unhandled_ = bytes.take<std::uint64_t>();
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) restore_state(bytes);
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) restore_history(bytes);
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    const EventId event = chart_.find_event(text_of(bytes));
    if (event == no_event || !post(event)) ++unhandled_;
  }
  list_active();
  fill_gaps();
  return bytes.ok() && (active_.empty() == (!started_ || finished_));
}

// In the chart's order: what is around a state came before it.
void ChartRunner::restore_state(ByteReader& bytes) {
  const StateIndex index = find_state(chart_, text_of(bytes));
  const auto bits = bytes.take<std::uint8_t>();
  const auto entered_ns = bytes.take<std::int64_t>();
  const EventId outcome = chart_.find_event(text_of(bytes));
  if (index == no_state || !bytes.ok()) return;
  const Chart::State& state = chart_.states[index];
  StateRun& run = run_[index];
  run.outcome = outcome;
  run.run_done = (bits & bit_run_done) != 0;
  run.entered_ns = entered_ns;
  if ((bits & (bit_active | bit_entering)) == 0 || state.kind == Chart::Kind::history) return;
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
}

void ChartRunner::restore_history(ByteReader& bytes) {
  const StateIndex history = find_state(chart_, text_of(bytes));
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    const StateIndex state = find_state(chart_, text_of(bytes));
    if (history == no_state || state == no_state || histories_[history].empty()) continue;
    if (!chart_.inside(state, chart_.states[history].parent)) continue;
    histories_[history][state] = remembered_[history] = true;
  }
}

EventId ChartRunner::known_event(const ChartRunner& old, EventId event) const noexcept {
  return event == no_event ? no_event : chart_.find_event(old.chart_.events[static_cast<std::size_t>(event)]);
}

void ChartRunner::take_over_state(const ChartRunner& old, StateIndex from, StateIndex to) noexcept {
  const StateRun& was = old.run_[from];
  StateRun& run = run_[to];
  run.active = was.active;
  run.run_done = was.run_done;
  run.entered_ns = was.entered_ns;
  run.outcome = known_event(old, was.outcome);
}

void ChartRunner::take_over_history(const ChartRunner& old, const std::vector<StateIndex>& map) noexcept {
  for (StateIndex history = 0; history < old.chart_.size(); ++history) {
    if (!old.remembered_[history] || map[history] == no_state) continue;
    const StateIndex to = map[history];
    for (StateIndex i = 0; i < old.chart_.size(); ++i) {
      if (!old.histories_[history][i] || map[i] == no_state) continue;
      histories_[to][map[i]] = true;
      remembered_[to] = true;
    }
  }
}

void ChartRunner::take_over(lua_State* state, const ChartRunner& old, const std::vector<StateIndex>& map) {
  now_ns_ = old.now_ns_;
  started_ = old.started_;
  filling_ = old.filling_;
  unhandled_ = old.unhandled_;
  for (StateIndex i = 0; i < old.chart_.size(); ++i) {
    if (map[i] != no_state) take_over_state(old, i, map[i]);
    if (map[i] != no_state && old.run_[i].entering) entering_ = run_[map[i]].entering = true;
  }
  take_over_history(old, map);
  for (std::uint32_t i = 0; i < old.event_count_; ++i) {
    const EventId event = known_event(old, old.events_[(old.event_first_ + i) % old.events_.size()]);
    if (event == no_event || !post(event)) ++unhandled_;
  }
  list_active();
  fill_gaps();
  start_runs(state);
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

void ChartRunner::report_gone(const ChartRunner& old, const std::vector<StateIndex>& map) noexcept {
  for (StateIndex i = 0; i < old.chart_.size(); ++i) {
    if (!old.run_[i].active || map[i] != no_state) continue;
    bool innermost = true;
    for (StateIndex j = static_cast<StateIndex>(i + 1); j < old.chart_.states[i].end; ++j) {
      innermost = innermost && !old.run_[j].active;
    }
    if (!innermost) continue;
    StateIndex around = i;
    while (map[around] == no_state) around = old.chart_.states[around].parent;
    const StateIndex stays = map[around], initial = chart_.states[stays].initial;
    sink_.transitioned(old.chart_.states[i].path, chart_.states[initial != no_state ? initial : stays].path, "reload");
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
