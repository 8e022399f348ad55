// A small interpreter of charts, written from SCXML's appendix D as it stands there: sets of states, and the procedures
// by their names. It knows nothing of src/script. What is ours on purpose (docs/behaviors_semantics.md) is named `ours`
// where it is done:
//
//   - without an event transitions are looked at once a tick; then come steps for events, 16 in all;
//   - one queue for all events; the oldest that is taken goes first; 32 sent ones wait; the rest of a tick is dropped;
//   - `always` goes before all others, outermost first; not when all of its targets are active;
//   - an outer `after` that was passed over goes first from the next tick on, outermost first;
//   - without a target and an event a transition takes nobody's turn, and its `after` comes once;
//   - the end of a state is an event that it and the states around it hear, up to the region; late it is withdrawn;
//   - a pattern takes no end of a state;
//   - a history counts where it stands when it is found out what a transition leaves;
//   - without a default a history leads to its parent's initial states, in a parallel to all regions.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace kadans::script_test {

struct RefTransition {
  int number = 0, source = 0;
  std::vector<int> targets;
  std::string event;  // "", a name, or a pattern
  int guard = -1;     // number of its condition
  int after_ms = -1;
  bool internal = false, always = false;
  std::string emits;  // by its action
};

struct RefState {
  enum class Kind { compound, atomic, parallel, region, final_state, history };
  std::string name;
  Kind kind = Kind::atomic;
  bool deep = false;
  int parent = -1;
  std::vector<int> children;
  std::vector<int> initial;                // targets; of a history: by default
  std::string outcome, emits;              // by its `enter`
  std::vector<RefTransition> transitions;  // in the order written
};

// Numbers of states are their places in document order; state 0 is the behavior.
class ReferenceChart {
 public:
  explicit ReferenceChart(std::vector<RefState> states) : states_(std::move(states)), history_(states_.size()) {}

  // What the functions of the chart say from the `during` of the tick before up to that of this tick, one word each:
  // .during +entered -left !action
  std::string tick(int tick, const std::vector<std::string>& sent);
  bool finished() const { return finished_; }
  static bool guard(int number, int tick) { return (tick * 7 + number * 13) % 5 < 2; }

 private:
  using States = std::set<int>;
  struct Event {
    std::string name;
    int from = -1;  // the state that ended
  };

  bool descendant(int state, int ancestor) const;
  bool atomic(int state) const;
  std::vector<int> proper_ancestors(int state, int up_to) const;
  bool matches(const RefTransition& transition, const Event* event) const;
  bool enabled(const RefTransition& transition, const Event* event) const;
  bool passes(const RefTransition& transition, const Event* event, std::vector<const RefTransition*>& found) const;
  std::vector<const RefTransition*> select(const Event* event);
  const RefTransition* find_always(int leaf, const Event* event, std::vector<const RefTransition*>& found) const;
  const RefTransition* find_other(int leaf, const Event* event, std::vector<const RefTransition*>& found) const;
  std::vector<const RefTransition*> without_conflicts(const std::vector<const RefTransition*>& enabled) const;
  void note_passed_over(const std::vector<const RefTransition*>& taken);
  States exit_set(const RefTransition& transition) const;
  int domain(const RefTransition& transition) const;
  States entry_set(const std::vector<const RefTransition*>& transitions) const;
  void add_descendants(int state, States& entered) const;
  void add_ancestors(int state, int ancestor, States& entered) const;
  void microstep(const std::vector<const RefTransition*>& transitions);
  void enter(const States& entered);
  void leave(int state);
  void complete(int state, const std::string& outcome);
  void goes_on(int state);
  void send(const std::string& event);
  bool take_event();

  std::vector<RefState> states_;
  States active_;
  std::vector<States> history_;
  std::map<int, int> entered_tick_;
  std::map<int, std::string> ended_;  // states that have ended, and how
  std::map<int, int> acted_;          // transitions that came, in the activation of this tick
  States passed_over_;
  std::deque<Event> queue_;
  int tick_ = 0;
  bool started_ = false, finished_ = false;
  std::string text_;
  std::string during_;  // said by the `during` of states inside the behavior
};

}  // namespace kadans::script_test
