// A behavior's state machine as flat arrays. It is made once from the author's tables and then runs without them.
//
// States are in document order: a state stands before its children, and its subtree is contiguous. So the test "is
// inside" takes two comparisons, entering goes up the numbers, and leaving goes down. State 0 is the behavior itself. A
// called behavior is inserted below the state that calls it, with a machine of its own: vars, arguments, names.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kadans/signal/fault.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/status.h"

namespace kadans {

using StateIndex = std::uint16_t;
inline constexpr StateIndex no_state = 0xffff;
using EventId = std::int32_t;
inline constexpr EventId no_event = -1;
inline constexpr EventId run_done_event = 0;  // "run.done"
inline constexpr EventId done_event = 1;      // "done"

// Reports: events that tell what happened to a behavior. "error" when one of its functions raised (chart_recovery.cpp),
// "refused" when the control engine refused one of its transactions, "fault.NAME" when the safety layer noted a fault.
// Nobody can send them. Where no active state waits for them they are no events at all.
bool reserved_for_reports(std::string_view event) noexcept;

struct Chart {
  enum class Kind : std::uint8_t { state, parallel, region, final_state, history };
  static constexpr int no_function = -2;  // the same as LUA_NOREF
  static constexpr std::int32_t no_parameter = -1;

  struct State {
    std::string name;
    std::string path;  // "stand.wait"; "" for the behavior itself
    std::string chunk;
    int line = 0;
    Kind kind = Kind::state;
    bool deep = false;           // of a history state
    bool endless = false;        // meant to stay: a missing way out is no mistake
    bool outcome_given = false;  // of a final state: the author wrote the outcome
    bool machine_root = false;   // root of a behavior, the played one or a called one
    StateIndex parent = no_state;
    StateIndex end = 0;                // one past the last state inside
    StateIndex initial = no_state;     // child entered by default; of a history state: the target without a history
    std::vector<StateIndex> defaults;  // what is entered by default: `initial`, or what is further inside of it
    std::uint16_t machine = 0;
    std::uint16_t first_transition = 0, transition_count = 0;
    std::uint16_t first_always = 0, always_count = 0;
    int enter = no_function, exit = no_function, during = no_function, run = no_function;  // registry references
    int result = no_function;    // final states: makes the data of the end
    EventId outcome = no_event;  // final states
    std::vector<std::string> initial_names;
    std::string outcome_name;
    std::vector<std::string> controls;  // names of the control sets that it runs on; none: those of the state around it
    SetMask sets = 0;                   // its own or inherited; 0: no state around it names any
  };
  struct Transition {
    StateIndex source = 0, target = no_state;  // no target: the action alone
    StateIndex domain = no_state;              // active states inside it are left; without a target none are
    int when = no_function, action = no_function;
    EventId on = no_event;
    std::int16_t pattern = -1;  // of `on`, when it is one
    bool internal = false;      // leads into its source, which is not left
    bool once = false;          // without a target: comes once each time its state is entered
    bool timed = false;
    double after_s = 0;
    std::int32_t after_parameter = no_parameter;
    std::string after_name;        // of that parameter
    std::vector<StateIndex> also;  // further targets, in other regions
    std::vector<std::string> target_names;
    std::string why;
    int line = 0;
    bool listed = false;  // a further event of on = { "a", "b" }: otherwise the same as the one before
    template <typename Visit>
    void each_target(Visit visit) const {
      if (target != no_state) visit(target);
      for (const StateIndex further : also) visit(further);
    }
  };
  // on = "fault.*": the events whose name is "fault" or begins with "fault."; on = "*": all. Never the end of a state.
  struct Pattern {
    EventId event = no_event;  // stands for the pattern itself; nobody can send it
    std::vector<bool> takes;   // by EventId
  };
  // What a call gives to a parameter of the behavior that it calls, or, when that is no constant, to an argument.
  struct Given {
    std::string name;
    std::int32_t parameter = no_parameter;  // in LuaCore::parameters; none: it is an argument
    std::int32_t follows = no_parameter;    // the caller's parameter whose value it has
    int function = no_function;             // evaluated when the behavior is entered
    double value = 0;                       // a constant
    int line = 0;                           // in call_chunk
  };
  struct Machine {
    std::string name;
    StateIndex root = 0;
    int vars = no_function, arguments = no_function;  // registry: as declared
    int given = no_function;                          // registry: constants given by the caller to arguments
    std::vector<Given> calls_with;
    int migrate = no_function;  // registry: converts vars of another version
    std::string call_chunk;     // file that calls it
    int call_line = 0;
    int version = 0;
  };

  std::string name;
  bool decides = false;  // a k.decisions: it plays behaviors, and has no control objects
  std::vector<State> states;
  std::vector<Transition> transitions;  // those of one state are contiguous
  std::vector<Machine> machines;
  std::vector<std::string> events{"run.done", "done"};
  std::vector<Pattern> patterns;
  // Reports; no_event: no transition waits for them.
  EventId error_event = no_event, refused_event = no_event;
  std::vector<std::pair<FaultCode, EventId>> fault_events;
  bool waits_for_reports = false;  // for refusals or faults
  std::vector<bool> takes_errors;  // by state: it, or a state around it, has a transition for "error"

  bool inside(StateIndex state, StateIndex ancestor) const noexcept {  // true also for the ancestor itself
    return state >= ancestor && state < states[ancestor].end;
  }
  // The transitions of a state: those without its `always`, and all of them, which stand together.
  std::span<const Transition> ordinary(const State& state) const {
    return std::span(transitions).subspan(state.first_transition, state.transition_count);
  }
  std::span<const Transition> transitions_of(const State& state) const {
    return std::span(transitions).subspan(state.first_transition, state.transition_count + state.always_count);
  }
  // The states directly inside, first to last.
  template <typename Visit>
  void each_child(StateIndex parent, Visit visit) const {
    for (auto child = static_cast<StateIndex>(parent + 1); child < states[parent].end; child = states[child].end)
      visit(child);
  }
  template <typename Visit>
  void each_region(StateIndex parallel, Visit visit) const {
    each_child(parallel, [&](StateIndex child) {
      if (states[child].kind == Kind::region) visit(child);
    });
  }
  // Whether the end of `ended` is an event for `state`: for itself and the states around it in its behavior, up to the
  // region that it is in.
  bool hears_end(StateIndex state, StateIndex ended) const noexcept;
  bool is_report(EventId event) const noexcept;
  // Events that nobody can send: the ends of coroutines and of states, reports, and patterns.
  bool made_by_runner(EventId event) const noexcept { return ends_[static_cast<std::size_t>(event)]; }
  StateIndex size() const noexcept { return static_cast<StateIndex>(states.size()); }
  EventId intern(std::string_view event);
  EventId find_event(std::string_view event) const noexcept;
  // Also an event that only a pattern takes: its name becomes known when it is sent for the first time, up to
  // late_events_max names.
  EventId find_or_learn(std::string_view event);
  static constexpr std::size_t late_events_max = 64, late_event_length_max = 64, patterns_max = 64;
  static bool is_pattern(std::string_view event) noexcept { return event.ends_with('*'); }
  std::int16_t intern_pattern(std::string_view pattern);
  bool any_pattern_takes(std::string_view event) const noexcept;
  bool takes_by_pattern(const Transition& transition, EventId event) const noexcept {
    return transition.pattern >= 0 &&
           patterns[static_cast<std::size_t>(transition.pattern)].takes[static_cast<std::size_t>(event)];
  }

  // Resolves all names and finds every mistake.
  void resolve(std::vector<InputProblem>& problems);

 private:
  std::vector<bool> ends_{true, true};  // by event
  std::size_t late_ = 0;                // names learnt

  // Finds the reports that transitions wait for; faults that do not exist are mistakes, and so are final states whose
  // outcome has such a name.
  void find_reports(std::vector<InputProblem>& problems);
};

}  // namespace kadans
