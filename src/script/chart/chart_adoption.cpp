// How a runner goes on where another one, of an older version of the chart, stood.
#include <lua.hpp>

#include "chart_runner.h"

namespace kadans {

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
