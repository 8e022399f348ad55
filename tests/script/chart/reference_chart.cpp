#include "reference_chart.h"

#include <algorithm>

namespace kadans::script_test {
namespace {

constexpr int steps_max = 16, sent_max = 32, tick_ms = 10;

}  // namespace

bool ReferenceChart::descendant(int state, int ancestor) const {
  for (int at = states_[static_cast<std::size_t>(state)].parent; at >= 0;
       at = states_[static_cast<std::size_t>(at)].parent) {
    if (at == ancestor) return true;
  }
  return false;
}

bool ReferenceChart::atomic(int state) const {
  const RefState::Kind kind = states_[static_cast<std::size_t>(state)].kind;
  return kind == RefState::Kind::atomic || kind == RefState::Kind::final_state;
}

std::vector<int> ReferenceChart::proper_ancestors(int state, int up_to) const {
  std::vector<int> all;
  for (int at = states_[static_cast<std::size_t>(state)].parent; at >= 0 && at != up_to;
       at = states_[static_cast<std::size_t>(at)].parent)
    all.push_back(at);
  return all;
}

bool ReferenceChart::matches(const RefTransition& transition, const Event* event) const {
  if (event == nullptr) return transition.event.empty();
  const std::string& wanted = transition.event;
  if (event->from >= 0) {  // ours: who hears an end
    if (wanted != event->name) return false;
    if (transition.source != event->from && !descendant(event->from, transition.source)) return false;
    for (int at = event->from; at != transition.source; at = states_[static_cast<std::size_t>(at)].parent) {
      if (states_[static_cast<std::size_t>(at)].kind == RefState::Kind::region) return false;
    }
    return true;
  }
  if (wanted == "*" || wanted == event->name) return true;
  if (!wanted.ends_with(".*")) return false;
  const std::string words = wanted.substr(0, wanted.size() - 2);
  return event->name == words || event->name.starts_with(words + ".");
}

bool ReferenceChart::enabled(const RefTransition& transition, const Event* event) const {
  if (!matches(transition, event)) return false;
  const int entered = entered_tick_.at(transition.source);
  if (transition.after_ms >= 0 && (tick_ - entered) * tick_ms < transition.after_ms) return false;
  if (transition.after_ms >= 0 && event == nullptr && transition.targets.empty()) {  // ours: it comes once
    const auto came = acted_.find(transition.number);
    if (came != acted_.end() && came->second == entered) return false;
  }
  return transition.guard < 0 || guard(transition.guard, tick_);
}

// ours: an action alone takes nobody's turn
bool ReferenceChart::passes(const RefTransition& transition, const Event* event,
                            std::vector<const RefTransition*>& found) const {
  if (event != nullptr || !transition.targets.empty()) return false;
  found.push_back(&transition);
  return true;
}

// ours: outermost first, and an `after` that was passed over counts as one
const RefTransition* ReferenceChart::find_always(int leaf, const Event* event,
                                                 std::vector<const RefTransition*>& found) const {
  std::vector<int> around = proper_ancestors(leaf, -1);
  std::reverse(around.begin(), around.end());
  around.push_back(leaf);
  for (const int state : around) {
    const auto& transitions = states_[static_cast<std::size_t>(state)].transitions;
    for (const RefTransition& one : transitions) {
      const bool there = !one.targets.empty() &&
                         std::ranges::all_of(one.targets, [&](int target) { return active_.contains(target); });
      if (one.always && !there && enabled(one, event) && !passes(one, event, found)) return &one;
    }
    if (event != nullptr || !passed_over_.contains(state)) continue;
    for (const RefTransition& one : transitions) {
      const bool timed = !one.always && one.after_ms >= 0;
      if (timed && enabled(one, event) && !passes(one, event, found)) return &one;
    }
  }
  return nullptr;
}

const RefTransition* ReferenceChart::find_other(int leaf, const Event* event,
                                                std::vector<const RefTransition*>& found) const {
  std::vector<int> around = proper_ancestors(leaf, -1);
  around.insert(around.begin(), leaf);
  for (const int state : around) {
    for (const RefTransition& one : states_[static_cast<std::size_t>(state)].transitions) {
      if (!one.always && enabled(one, event) && !passes(one, event, found)) return &one;
    }
  }
  return nullptr;
}

// selectTransitions and selectEventlessTransitions
std::vector<const RefTransition*> ReferenceChart::select(const Event* event) {
  std::vector<const RefTransition*> found;
  std::vector<int> undecided;
  for (const int state : active_) {
    if (!atomic(state)) continue;
    if (const RefTransition* one = find_always(state, event, found)) {
      found.push_back(one);
    } else {
      undecided.push_back(state);
    }
  }
  for (const int state : undecided) {
    if (const RefTransition* one = find_other(state, event, found)) found.push_back(one);
  }
  std::vector<const RefTransition*> once;
  for (const RefTransition* one : found) {
    if (std::ranges::find(once, one) == once.end()) once.push_back(one);
  }
  const std::vector<const RefTransition*> taken = without_conflicts(once);
  if (event == nullptr) note_passed_over(taken);
  return taken;
}

// removeConflictingTransitions
std::vector<const RefTransition*> ReferenceChart::without_conflicts(
    const std::vector<const RefTransition*>& enabled) const {
  std::vector<const RefTransition*> filtered;
  for (const RefTransition* t1 : enabled) {
    bool preempted = false;
    std::vector<const RefTransition*> to_remove;
    for (const RefTransition* t2 : filtered) {
      const States one = exit_set(*t1), other = exit_set(*t2);
      if (std::ranges::none_of(one, [&](int state) { return other.contains(state); })) continue;
      if (!descendant(t1->source, t2->source)) {
        preempted = true;
        break;
      }
      to_remove.push_back(t2);
    }
    if (preempted) continue;
    for (const RefTransition* t3 : to_remove) std::erase(filtered, t3);
    filtered.push_back(t1);
  }
  return filtered;
}

// ours: every `after` that is due, and is not taken for one that is
void ReferenceChart::note_passed_over(const std::vector<const RefTransition*>& taken) {
  for (const int state : active_) {
    for (const RefTransition& due : states_[static_cast<std::size_t>(state)].transitions) {
      if (due.always || due.after_ms < 0 || !due.event.empty()) continue;
      if (std::ranges::find(taken, &due) != taken.end()) continue;
      RefTransition unguarded = due;
      unguarded.guard = -1;
      if (!enabled(unguarded, nullptr)) continue;
      const States its = exit_set(due);
      for (const RefTransition* one : taken) {
        const States others = exit_set(*one);
        const bool hidden =
            due.targets.empty() && !one->targets.empty() && (one->source == state || descendant(one->source, state));
        if (hidden || std::ranges::any_of(its, [&](int left) { return others.contains(left); }))
          passed_over_.insert(state);
      }
    }
  }
}

// computeExitSet
ReferenceChart::States ReferenceChart::exit_set(const RefTransition& transition) const {
  States left;
  if (transition.targets.empty()) return left;
  const int around = domain(transition);
  for (const int state : active_) {
    if (descendant(state, around)) left.insert(state);
  }
  return left;
}

// getTransitionDomain with findLCCA; ours: a history counts where it stands, and nothing leaves the behavior
int ReferenceChart::domain(const RefTransition& transition) const {
  const auto holds_all = [&](int state) {
    return std::ranges::all_of(transition.targets, [&](int target) { return descendant(target, state); });
  };
  if (transition.source == 0) return 0;
  if (transition.internal && holds_all(transition.source)) return transition.source;
  for (const int state : proper_ancestors(transition.source, -1)) {
    if (states_[static_cast<std::size_t>(state)].kind != RefState::Kind::parallel && holds_all(state)) return state;
  }
  return 0;
}

// computeEntrySet
ReferenceChart::States ReferenceChart::entry_set(const std::vector<const RefTransition*>& transitions) const {
  States entered;
  for (const RefTransition* one : transitions) {
    for (const int target : one->targets) add_descendants(target, entered);
    if (one->targets.empty()) continue;
    const int ancestor = domain(*one);
    for (const int target : one->targets) {
      const RefState& state = states_[static_cast<std::size_t>(target)];
      if (state.kind != RefState::Kind::history) {
        add_ancestors(target, ancestor, entered);
        continue;
      }
      const States& remembered = history_[static_cast<std::size_t>(target)];  // getEffectiveTargetStates
      const States effective = remembered.empty() ? States(state.initial.begin(), state.initial.end()) : remembered;
      for (const int its : effective) add_ancestors(its, ancestor, entered);
    }
  }
  return entered;
}

// addDescendantStatesToEnter
void ReferenceChart::add_descendants(int number, States& entered) const {
  const RefState& state = states_[static_cast<std::size_t>(number)];
  if (state.kind == RefState::Kind::history) {
    const States& remembered = history_[static_cast<std::size_t>(number)];
    const States all = remembered.empty() ? States(state.initial.begin(), state.initial.end()) : remembered;
    for (const int its : all) add_descendants(its, entered);
    for (const int its : all) add_ancestors(its, state.parent, entered);
    return;
  }
  entered.insert(number);
  if (state.kind == RefState::Kind::parallel) {
    for (const int child : state.children) {
      if (states_[static_cast<std::size_t>(child)].kind == RefState::Kind::history) continue;
      const bool some = std::ranges::any_of(entered, [&](int one) { return descendant(one, child); });
      if (!some) add_descendants(child, entered);
    }
    return;
  }
  for (const int target : state.initial) add_descendants(target, entered);
  for (const int target : state.initial) add_ancestors(target, number, entered);
}

// addAncestorStatesToEnter
void ReferenceChart::add_ancestors(int number, int ancestor, States& entered) const {
  for (const int around : proper_ancestors(number, ancestor)) {
    entered.insert(around);
    const RefState& state = states_[static_cast<std::size_t>(around)];
    if (state.kind != RefState::Kind::parallel) continue;
    for (const int child : state.children) {
      if (states_[static_cast<std::size_t>(child)].kind == RefState::Kind::history) continue;
      const bool some = std::ranges::any_of(entered, [&](int one) { return descendant(one, child); });
      if (!some) add_descendants(child, entered);
    }
  }
}

// exitStates, the actions, enterStates
void ReferenceChart::microstep(const std::vector<const RefTransition*>& transitions) {
  States left;
  for (const RefTransition* one : transitions) left.merge(exit_set(*one));
  for (const int state : left) {
    for (const int child : states_[static_cast<std::size_t>(state)].children) {
      const RefState& history = states_[static_cast<std::size_t>(child)];
      if (history.kind != RefState::Kind::history) continue;
      States& value = history_[static_cast<std::size_t>(child)];
      value.clear();
      for (const int one : active_) {
        const bool counts = history.deep ? atomic(one) && descendant(one, state)
                                         : states_[static_cast<std::size_t>(one)].parent == state;
        if (counts) value.insert(one);
      }
    }
  }
  const States entered = entry_set(transitions);
  for (auto state = left.rbegin(); state != left.rend(); ++state) leave(*state);
  for (const RefTransition* one : transitions) {
    if (one->after_ms >= 0 && one->targets.empty() && one->event.empty())
      acted_[one->number] = entered_tick_[one->source];
    text_ += "!" + std::to_string(one->number) + " ";
    if (!one->emits.empty()) send(one->emits);
  }
  enter(entered);
}

void ReferenceChart::leave(int state) {
  active_.erase(state);
  ended_.erase(state);
  passed_over_.erase(state);
  std::erase_if(queue_, [&](const Event& event) { return event.from == state; });
  const RefState& left = states_[static_cast<std::size_t>(state)];
  if (left.kind == RefState::Kind::final_state) return goes_on(left.parent);
  text_ += "-" + left.name + " ";
}

// ours: the end that was not taken is withdrawn
void ReferenceChart::goes_on(int state) {
  if (state == 0) return;
  ended_.erase(state);
  std::erase_if(queue_, [&](const Event& event) { return event.from == state; });
  const RefState& it = states_[static_cast<std::size_t>(state)];
  if (it.kind == RefState::Kind::region) goes_on(it.parent);
}

void ReferenceChart::enter(const States& entered) {
  for (const int state : entered) {
    const RefState& it = states_[static_cast<std::size_t>(state)];
    active_.insert(state);
    entered_tick_[state] = tick_;
    passed_over_.erase(state);
    ended_.erase(state);
    text_ += "+" + it.name + " ";
    if (!it.emits.empty()) send(it.emits);
    if (it.kind == RefState::Kind::final_state) complete(it.parent, it.outcome);
  }
}

void ReferenceChart::complete(int state, const std::string& outcome) {
  ended_[state] = outcome;
  if (state == 0) return;
  std::erase_if(queue_, [&](const Event& event) { return event.from == state; });
  queue_.push_back({outcome, state});
  const RefState& it = states_[static_cast<std::size_t>(state)];
  if (it.kind != RefState::Kind::region) return;
  std::string together = "done";
  for (const int region : states_[static_cast<std::size_t>(it.parent)].children) {
    if (states_[static_cast<std::size_t>(region)].kind == RefState::Kind::history) continue;
    const auto its = ended_.find(region);
    if (its == ended_.end()) return;
    if (together == "done") together = its->second;
  }
  complete(it.parent, together);
}

void ReferenceChart::send(const std::string& event) {
  const auto sent = std::ranges::count_if(queue_, [](const Event& one) { return one.from < 0; });
  if (sent < sent_max) queue_.push_back({event});
}

bool ReferenceChart::take_event() {
  for (auto event = queue_.begin(); event != queue_.end(); ++event) {
    const Event taken = *event;
    const std::vector<const RefTransition*> transitions = select(&taken);
    if (transitions.empty()) continue;
    queue_.erase(event);
    microstep(transitions);
    return true;
  }
  return false;
}

std::string ReferenceChart::tick(int tick, const std::vector<std::string>& sent) {
  text_ = during_;
  during_.clear();
  tick_ = tick;
  if (finished_) return "";
  for (const std::string& event : sent) send(event);
  if (!started_) {
    started_ = true;
    States entered;
    add_descendants(0, entered);
    enter(entered);
  } else {
    const std::vector<const RefTransition*> transitions = select(nullptr);
    microstep(transitions);
  }
  for (int steps = 1; steps < steps_max && !ended_.contains(0) && take_event(); ++steps) {
  }
  if (ended_.contains(0)) {
    finished_ = true;
    const States all = active_;
    for (auto state = all.rbegin(); state != all.rend(); ++state) leave(*state);
    return text_;
  }
  queue_.clear();
  for (const int state : active_) {
    const bool has = state != 0 && states_[static_cast<std::size_t>(state)].kind != RefState::Kind::final_state;
    if (has) during_ += "." + states_[static_cast<std::size_t>(state)].name + " ";
  }
  return text_;
}

}  // namespace kadans::script_test
