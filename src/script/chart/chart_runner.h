// Runs a chart, one tick at a time. A tick works against one snapshot:
//
//   1. Each innermost active state looks for an enabled transition among the `always` of itself and of the states
//   around
//      it, from the outside in.
//   2. Each that found none looks among their other transitions, from the inside out, in the order written.
//   3. Of transitions that would leave the same state the first one is taken, unless a later one starts further inside
//      (SCXML, section D, removeConflictingTransitions). So an `always` of any region goes before other transitions.
//   4. All exits run, innermost and last first, then the actions, then all entries, outermost and first first.
//   5. The `during` functions run, then the coroutines of `run`.
//
// So a tick takes one step, and its effects are seen in the next tick.
//
// Events wait in a bounded queue, and a tick looks at the oldest one. An event that no transition takes is dropped and
// counted. It stays in the queue while transitions without an event are taken.
//
// tick() and stop() call into Lua, and its errors unwind through them. So no function here holds an object that needs a
// destructor. They allocate nothing beyond what the script allocates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "chart.h"

struct lua_State;

namespace kadans {

class ByteReader;
class ByteWriter;
struct Motion;
class StepMeter;

// Registry references of the values that are passed to the chart's functions.
struct RunnerTables {
  struct Machine {
    int handle = Chart::no_function;   // m
    int content = Chart::no_function;  // the table behind m
  };
  std::vector<Machine> machines;
  int snapshot = Chart::no_function;  // s
  int threads = Chart::no_function;   // keeps the coroutines alive
  int time_key = Chart::no_function;  // "time_s"
};

class TransitionSink {
 public:
  virtual ~TransitionSink() = default;
  virtual void transitioned(const std::string& from, const std::string& to, const std::string& why) noexcept = 0;
};

class ChartRunner {
 public:
  // Make it before the first tick. All references must outlive the runner.
  ChartRunner(const Chart& chart, const RunnerTables& tables, TransitionSink& sink);

  void tick(lua_State* state, std::int64_t now_ns);
  // Leaves all active states, `exit` innermost first.
  void stop(lua_State* state, std::int64_t now_ns);

  // False when the queue is full; this is counted.
  bool post(EventId event) noexcept;

  // For a reload and for another process: the runner before writes itself with keep(); this one calls restore() before
  // the first tick, and start_runs() once the machines have their vars. Active states, their time, histories and
  // waiting events are carried over. A coroutine cannot be carried over: `run` begins anew, unless it was over. When an
  // active state no longer exists, the next tick enters the initial state of the state around it. False: the bytes do
  // not come from keep(); then the runner cannot be used.
  void keep(ByteWriter& bytes) const;
  [[nodiscard]] bool restore(ByteReader& bytes);
  void start_runs(lua_State* state);
  void be_at(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }
  // Evaluates the guards of all active states to find errors that they raise.
  void try_guards(lua_State* state);
  // Leaves these states, `exit` innermost first.
  void leave_marked(lua_State* state, const std::vector<bool>& marks, std::int64_t now_ns);
  // Which of its active states the other one has not active: a mark for each state.
  std::vector<bool> gone_from(const ChartRunner& other) const;
  // Tells the sink which active states of the old runner are gone.
  void report_gone(const ChartRunner& old, const std::vector<bool>& gone) noexcept;
  // The next tick enters the states again that leave_marked() left.
  void enter_again(const std::vector<bool>& marks) noexcept;

  bool started() const noexcept { return started_; }
  bool finished() const noexcept { return finished_; }
  EventId outcome() const noexcept { return run_[0].outcome; }
  bool active(StateIndex state) const noexcept { return run_[state].active; }
  StateIndex innermost() const noexcept;  // active state, the first when there are several; 0 before the first tick
  double state_time_s(StateIndex state) const noexcept;
  std::uint64_t events_unhandled() const noexcept { return unhandled_; }
  // What the running coroutine waits for: set by the bindings just before they yield.
  void wait_for(Motion* motion) noexcept { wait_motion_ = motion; }
  void wait_until(std::int64_t time_ns) noexcept { wait_ns_ = time_ns; }
  std::int64_t now_ns() const noexcept { return now_ns_; }

 private:
  struct StateRun {
    bool active = false, run_done = false;
    bool entering = false, leaving = false;
    bool decided = false;  // an `always` was found for it in this tick
    EventId outcome = no_event;
    std::int64_t entered_ns = 0;
    lua_State* thread = nullptr;
    bool thread_started = false;
    Motion* motion = nullptr;  // the motion that it waits for
    std::int64_t wake_ns = 0;
  };
  enum class Guard : std::uint8_t { unknown, no, yes };

  void select(lua_State* state, EventId event, bool events_only);
  std::uint16_t select_always(lua_State* state, StepMeter& meter, StateIndex leaf, EventId event, bool events_only);
  std::uint16_t select_ordinary(lua_State* state, StepMeter& meter, StateIndex leaf, EventId event, bool events_only);
  bool is_leaf(std::size_t position) const noexcept;
  bool enabled(lua_State* state, std::uint16_t transition, EventId event, bool events_only);
  bool guard(lua_State* state, std::uint16_t transition);
  void add_selected(std::uint16_t transition) noexcept;
  bool took(EventId event) const noexcept;

  void look_for_transitions(lua_State* state);
  void take_step(lua_State* state);
  void leave(lua_State* state, StateIndex index);
  void enter(lua_State* state, StateIndex index);
  void complete(StateIndex index, EventId outcome) noexcept;
  void go_on(StateIndex index) noexcept;
  void mark_entry(StateIndex target) noexcept;
  void mark_ancestors(StateIndex target, StateIndex domain) noexcept;
  bool marked_inside(StateIndex index) const noexcept;
  void mark_history(StateIndex history) noexcept;
  void remember(StateIndex index) noexcept;
  void list_active() noexcept;
  void report(std::uint16_t transition) noexcept;

  void fill_gaps() noexcept;
  void fill(StateIndex around, StateIndex entered) noexcept;
  void keep_histories(ByteWriter& bytes) const;
  [[nodiscard]] bool restore_state(ByteReader& bytes, std::vector<bool>& listed);
  void restore_history(ByteReader& bytes);

  void set_time(lua_State* state, StateIndex index);
  void call(lua_State* state, int function, StateIndex index);
  void start_run(lua_State* state, StateIndex index);
  void resume_run(lua_State* state, StateIndex index);
  void cancel_run(lua_State* state, StateIndex index);
  bool ready(lua_State* state, StateRun& run, lua_State* thread, int& arguments) const noexcept;

  const Chart& chart_;
  const RunnerTables& tables_;
  TransitionSink& sink_;
  std::vector<StateRun> run_;
  std::vector<StateIndex> active_;            // in document order
  std::vector<std::uint16_t> selected_;       // transitions
  std::vector<Guard> guards_;                 // one for each transition, for this tick
  std::vector<std::vector<bool>> histories_;  // one for each state; empty when it has no history
  std::vector<bool> remembered_;
  std::array<EventId, 32> events_{};
  std::uint32_t event_first_ = 0, event_count_ = 0;
  std::uint64_t unhandled_ = 0;
  std::int64_t now_ns_ = 0;
  bool started_ = false, finished_ = false;
  bool entering_ = false;  // some state is marked to be entered
  bool filling_ = false;   // the next tick only enters what a reload left empty; it takes no transition
  Motion* wait_motion_ = nullptr;
  std::int64_t wait_ns_ = 0;
};

}  // namespace kadans
