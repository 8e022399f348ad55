// Runs a chart, one tick at a time. A tick works against one snapshot. Its first step looks at transitions without an
// event:
//
//   1. Each innermost active state looks among the `always` of itself and of the states around it, from the outside in.
//      The `after` of a state around it that was passed over in an earlier tick counts as such.
//   2. Each that found none looks among their other transitions, from the inside out, in the order written.
//   3. Of transitions that would leave the same state the first one is taken, unless a later one starts further inside
//      (SCXML, section D, removeConflictingTransitions). So an `always` of any region goes before other transitions.
//      A transition without a target leaves nothing. Without an event it takes nobody's turn: the search goes on.
//   4. All exits run, innermost and last first, then the actions, then all entries, outermost and first first. Between
//      actions and entries the control sets are switched to that the active states run on from now on.
//
// Then, as long as events wait, further steps of the same kind follow, each for one event: the oldest that an active
// state takes. Only transitions with this event are looked at. A tick has at most steps_max steps. What waits after the
// last one is dropped, counted and told. Then the `during` functions run, and the coroutines of `run`.
//
// The end of a state is an event, too. It reaches the state that ended and the states around it in its behavior, up to
// the region that it is in: what is around a region hears how all the regions ended. When the state goes on or is left
// before its end was taken, the end is withdrawn.
//
// tick() and stop() call into Lua, and its errors unwind through them. So no function here holds an object that needs a
// destructor. They allocate nothing beyond what the script allocates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "chart.h"
#include "event_queue.h"
#include "script/lua/script_error.h"

struct lua_State;

namespace kadans {

class ByteReader;
class ByteWriter;
struct Motion;
class ScriptVoice;
class StepMeter;

// Registry references of the values that are passed to the chart's functions.
struct RunnerTables {
  struct Machine {
    int handle = Chart::no_function;   // m
    int content = Chart::no_function;  // the table behind m
  };
  std::vector<Machine> machines;
  int snapshot = Chart::no_function;     // s
  int threads = Chart::no_function;      // keeps the coroutines alive
  int time_key = Chart::no_function;     // "time_s"
  int event = Chart::no_function;        // content of s.event
  int event_names = Chart::no_function;  // by EventId + 1
  int event_data = Chart::no_function;   // by place + 1; behind them that of an error, and what s.event shows
  int results = Chart::no_function;      // of final states, by StateIndex + 1
  int make_result = Chart::no_function;  // calls a function with m and s and copies what it returns
};

// Which of the state's functions this is, by its registry reference: "enter", "when"; "call": one of a call's values.
const char* cause_of(const Chart& chart, StateIndex index, int function) noexcept;

class ChartRunner {
 public:
  // Make it before the first tick. All references must outlive the runner.
  ChartRunner(Chart& chart, const RunnerTables& tables, ScriptVoice& voice);

  static constexpr std::uint32_t steps_max = 16;
  static constexpr std::uint32_t restless_ticks =
      500;  // 5 s at 100 Hz: a chart that counts or searches is over by then

  void tick(lua_State* state, std::int64_t now_ns);
  // Leaves all active states, `exit` innermost first.
  void stop(lua_State* state, std::int64_t now_ns);

  // False when the queue is full.
  bool post(EventId event) noexcept { return queue_.send(event, -1); }
  bool post_with_data(lua_State* state, EventId event);  // [-1 +0] with the data at the top of the stack
  const EventQueue& events() const noexcept { return queue_; }
  bool waits_for(EventId event) const noexcept;  // whether an active state has a transition for it

  // For a reload and for another process: the runner before writes itself with keep(); this one calls restore() before
  // the first tick, and start_runs() once the machines have their vars. Active states, their time, histories and
  // waiting events are carried over. A coroutine cannot be carried over: `run` begins anew, unless it was over. When an
  // active state no longer exists, the next tick enters the initial state of the state around it. False: the bytes do
  // not come from keep(); then the runner cannot be used.
  void keep(ByteWriter& bytes) const;
  [[nodiscard]] bool restore(ByteReader& bytes);
  void start_runs(lua_State* state);
  void be_at(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }
  // [-0 +1] The value of the transition's `when`. Raises what it raises.
  void call_guard(lua_State* state, std::uint16_t transition);
  // Evaluates the guards of all active states to find errors that they raise.
  void try_guards(lua_State* state);
  // Leaves these states, `exit` innermost first.
  void leave_marked(lua_State* state, const std::vector<bool>& marks, std::int64_t now_ns);
  // Which of its active states the other one has not active: a mark for each state.
  std::vector<bool> gone_from(const ChartRunner& other) const;
  // Tells the voice which active states of the old runner are gone.
  void report_gone(const ChartRunner& old, const std::vector<bool>& gone) noexcept;
  // The next tick enters the states again that leave_marked() left.
  void enter_again(const std::vector<bool>& marks) noexcept;

  bool started() const noexcept { return started_; }
  bool finished() const noexcept { return finished_; }
  EventId outcome() const noexcept { return run_[0].outcome; }
  StateIndex finished_by() const noexcept { return finished_by_; }  // the final state that it ended in, or no_state
  // [-0 +1 when true] Once the behavior is finished: the result of the final state that it reached.
  bool push_result(lua_State* state) const;
  bool active(StateIndex state) const noexcept { return run_[state].active; }
  std::span<const StateIndex> active_states() const noexcept { return active_; }  // in document order
  bool is_leaf(std::size_t position) const noexcept;                              // among them: none inside is active
  // The active state in `around`, the first when there are several; `around` itself when none in it is.
  StateIndex innermost(StateIndex around = 0) const noexcept;
  double state_time_s(StateIndex state) const noexcept;
  double after_s(lua_State* state, const Chart::Transition& transition) const noexcept;  // of a timed one
  bool run_done(StateIndex state) const noexcept { return run_[state].run_done; }
  // Its `run` has begun, and is not over.
  bool run_under_way(StateIndex state) const noexcept {
    return run_[state].thread != nullptr && run_[state].thread_started && !run_[state].run_done;
  }
  // The control sets that its innermost active states run on, those that are being entered with them or alone.
  enum class Asking : std::uint8_t { all, entering };
  SetMask sets_asked(Asking asking = Asking::all) const noexcept;
  const Chart& chart() const noexcept { return chart_; }
  const Chart::State& acting() const noexcept { return chart_.states[acting_]; }  // whose function ran last
  StateIndex acting_index() const noexcept { return acting_; }
  std::uint64_t events_unhandled() const noexcept { return unhandled_; }
  // [-0 +1] A copy of the data of the event that s.event shows, for the function that runs; nil when it has none.
  void push_shown_data(lua_State* state);
  // [-0 +1] The arguments of the behavior whose function runs.
  void push_arguments(lua_State* state) const;
  // [-1 +0] Gives a machine the value at the top, which is as declared, for one of those that its call gives.
  void give(lua_State* state, std::uint16_t machine, std::size_t number);
  // What the running coroutine waits for: set by the bindings just before they yield.
  void wait_for(Motion* motion) noexcept { wait_motion_ = motion; }
  void wait_until(std::int64_t time_ns) noexcept { wait_ns_ = time_ns; }
  std::int64_t now_ns() const noexcept { return now_ns_; }

 private:
  struct StateRun {
    bool active = false, run_done = false;
    bool entering = false, leaving = false;
    bool decided = false;      // an `always` was found for it in this step
    bool passed_over = false;  // one of its `after` was due, and a transition was taken that would not let it
    bool stopped = false;      // by an error: its `run` does not go on, and what was not entered inside it stays so
    EventId outcome = no_event;
    std::int64_t entered_ns = 0;
    lua_State* thread = nullptr;
    bool thread_started = false;
    Motion* motion = nullptr;  // the motion that it waits for
    std::int64_t wake_ns = 0;
    std::uint32_t restless = 0;    // ticks in a row in which states took no time, up to its entry
    std::int64_t restless_ns = 0;  // at that entry
  };
  static constexpr std::int64_t never_ns = std::numeric_limits<std::int64_t>::min();
  struct Guard {
    std::uint64_t look = 0;  // when it was evaluated
    bool yes = false;
    std::int64_t acted_ns = never_ns;  // when the state was entered in which a transition that comes once has come
  };

  // With an event: among the transitions that have it; without one: among those that have none.
  void select(lua_State* state, const WaitingEvent* event);
  std::uint16_t select_always(lua_State* state, StepMeter& meter, StateIndex leaf, const WaitingEvent* event);
  std::uint16_t select_ordinary(lua_State* state, StepMeter& meter, StateIndex leaf, const WaitingEvent* event);
  std::uint16_t select_passed_over(lua_State* state, StepMeter& meter, StateIndex outer);
  void note_passed_over(lua_State* state, StepMeter& meter);
  void push_guard(lua_State* state, std::uint16_t transition);
  template <typename Takes>
  bool has_transition_for(StateIndex index, Takes takes) const noexcept {
    return std::ranges::any_of(chart_.transitions_of(chart_.states[index]), takes);
  }
  bool enabled(lua_State* state, std::uint16_t transition, const WaitingEvent* event);
  bool happened(std::uint16_t transition, const WaitingEvent* event) const noexcept;
  bool due(lua_State* state, std::uint16_t transition) const;
  bool guard(lua_State* state, std::uint16_t transition);
  bool there_already(const Chart::Transition& transition) const noexcept;
  bool acted(std::uint16_t transition) const noexcept;
  bool lets_pass(StepMeter& meter, std::uint16_t transition, const WaitingEvent* event);
  void add_selected(StepMeter& meter, std::uint16_t transition);
  bool passes_over(std::uint16_t taken, std::uint16_t due) const noexcept;
  bool conflict(std::uint16_t one, std::uint16_t other) const noexcept;

  void first_step(lua_State* state);
  bool select_event(lua_State* state, bool ends_only = false);
  void drop_events(lua_State* state, std::uint32_t steps);
  void show_event(lua_State* state, const WaitingEvent& event);
  void push_event_name(lua_State* state, EventId event);
  void hide_event(lua_State* state);
  void forget_copy(lua_State* state);
  void forget_data(lua_State* state, const WaitingEvent& event);
  void push_outcomes(lua_State* state, StateIndex parallel);
  StateIndex final_in(StateIndex index) const noexcept;
  bool push_result_of(lua_State* state, StateIndex ended) const;  // [-0 +1 when true] of a final state
  bool make_result(lua_State* state, StateIndex index);
  void take_step(lua_State* state);
  void leave(lua_State* state, StateIndex index);
  void enter(lua_State* state, StateIndex index);
  void complete(StateIndex index, EventId outcome) noexcept;
  bool waits_for_end(StateIndex ended, EventId outcome) const noexcept;
  void go_on(StateIndex index) noexcept;
  void mark_entry(StateIndex target) noexcept;
  void mark_defaults(StateIndex index, StateIndex around) noexcept;
  void mark_targets(const Chart::Transition& transition) noexcept;
  void mark_ancestors(StateIndex target, StateIndex domain) noexcept;
  bool marked_inside(StateIndex index) const noexcept;
  void mark_history(StateIndex history) noexcept;
  void remember(StateIndex index) noexcept;
  void list_active() noexcept;
  void act(lua_State* state, std::uint16_t transition);
  void report(lua_State* state, std::uint16_t transition) noexcept;
  void note_restless(lua_State* state, const Chart::Transition& transition, StateIndex from) noexcept;

  void fill_gaps() noexcept;
  void fill(StateIndex around, StateIndex entered) noexcept;
  void keep_acted(const Chart::State& state, ByteWriter& bytes) const;
  void restore_acted(StateIndex index, ByteReader& bytes);
  void keep_histories(ByteWriter& bytes) const;
  [[nodiscard]] bool restore_state(ByteReader& bytes, std::vector<bool>& listed);
  void restore_history(ByteReader& bytes);

  // What is taken back when a function raises; chart_recovery.cpp.
  struct Attempt;
  Attempt begin_attempt(lua_State* state) const noexcept;
  // [-arguments-1 +results when true] Calls the function below its arguments.
  bool call_recoverably(lua_State* state, StateIndex index, int arguments, int results);
  int resume_recoverably(lua_State* state, StateIndex index, int arguments);
  static void keep_run_error(lua_State* state, lua_State* thread);
  void note_failure(lua_State* state, StateIndex index, const Attempt& attempt);
  void fail(lua_State* state, StateIndex index);
  void recover(lua_State* state);
  void recover_late(lua_State* state);
  void enter_no_further(StateIndex index) noexcept;
  // Evaluates what the call of a machine that is being entered gives to it. False: as call().
  bool evaluate_call(lua_State* state, std::uint16_t machine);
  void set_time(lua_State* state, StateIndex index);
  // [-0 +3] The function and its arguments, m and s.
  void push_call(lua_State* state, int function, StateIndex index);
  // False: an error waits that is going to be an event.
  bool call(lua_State* state, int function, StateIndex index);
  void start_run(lua_State* state, StateIndex index);
  void resume_run(lua_State* state, StateIndex index);
  void cancel_run(lua_State* state, StateIndex index);
  bool ready(lua_State* state, StateRun& run, lua_State* thread, int& arguments) const noexcept;

  Chart& chart_;  // learns names of events
  const RunnerTables& tables_;
  ScriptVoice& voice_;
  std::vector<StateRun> run_;
  std::vector<StateIndex> active_;            // in document order
  std::vector<std::uint16_t> selected_;       // transitions
  std::vector<Guard> guards_;                 // one for each transition
  std::uint64_t look_ = 0;                    // counts select()
  std::vector<std::vector<bool>> histories_;  // one for each state; empty when it has no history
  std::vector<bool> remembered_;
  EventQueue queue_;
  std::vector<bool> told_;  // events that were told as dropped
  bool told_steps_ = false, told_restless_ = false;
  WaitingEvent shown_;        // the event of the step, for s.event
  bool data_copied_ = false;  // the function that runs has a copy of its data
  std::uint64_t unhandled_ = 0;
  std::int64_t now_ns_ = 0, before_ns_ = 0;  // of this tick and of the one before
  StateIndex acting_ = 0;
  bool started_ = false, finished_ = false;
  bool recoverable_ = false;  // an error of a function can be an event: none was yet in this tick
  bool failed_ = false;       // one waits to be taken
  bool entering_ = false;     // some state is marked to be entered
  bool filling_ = false;      // the next tick only enters what a reload left empty; it takes no transition
  Motion* wait_motion_ = nullptr;
  std::int64_t wait_ns_ = 0;
  StateIndex finished_by_ = no_state;  // the final state
  StateIndex failed_in_ = 0;           // whose function raised
  ScriptError failure_;
};

}  // namespace kadans
