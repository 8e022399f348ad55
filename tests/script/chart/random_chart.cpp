#include "random_chart.h"

#include <algorithm>

namespace kadans::script_test {
namespace {

using Kind = RefState::Kind;

constexpr int states_max = 22, guards = 6;
constexpr const char* names_of_events[] = {"a", "b", "x", "x.p", "x.q", "x.p.r", "xy"};
constexpr const char* patterns[] = {"*", "x.*", "x.p.*"};

}  // namespace

void RandomChart::make() {
  add(Kind::compound, -1);
  fill(0, 0);
  choose_initials();
  add_transitions();
  add_emits();
}

int RandomChart::add(Kind kind, int parent) {
  const int number = static_cast<int>(states_.size());
  RefState& made = states_.emplace_back();
  made.name = "s" + std::to_string(number);
  made.kind = kind;
  made.parent = parent;
  if (parent >= 0) at(parent).children.push_back(number);
  if (kind == Kind::final_state) made.outcome = chance(60) ? "done" : "lost";
  return number;
}

void RandomChart::fill(int state, int depth) {
  const bool parallel = at(state).kind == Kind::parallel;
  const int children = parallel ? 2 + below(2) : depth == 0 ? 2 + below(2) : 1 + below(3);
  for (int i = 0; i < children; ++i) {
    const bool deeper = depth < 4 && static_cast<int>(states_.size()) < states_max;
    if (parallel) {
      fill(add(Kind::region, state), depth + 1);
    } else if (deeper && chance(20)) {
      fill(add(Kind::parallel, state), depth + 1);
    } else if (deeper && chance(35)) {
      fill(add(Kind::compound, state), depth + 1);
    } else {
      add(i > 0 && chance(depth == 0 ? 10 : 30) ? Kind::final_state : Kind::atomic, state);
    }
  }
  if (state == 0 || !chance(35)) return;
  const int history = add(Kind::history, state);
  at(history).deep = parallel || chance(50);
}

bool RandomChart::inside(int state, int ancestor) const {
  while (state > ancestor) state = at(state).parent;
  return state == ancestor;
}

// Whether both can be active: they are in different regions of one parallel.
bool RandomChart::together(int one, int other) const {
  if (inside(one, other) || inside(other, one)) return false;
  int around = one, its = one, others = other;
  while (!inside(other, around)) its = around, around = at(around).parent;
  while (at(others).parent != around) others = at(others).parent;
  return at(around).kind == Kind::parallel && at(its).kind == Kind::region && at(others).kind == Kind::region;
}

std::vector<int> RandomChart::candidates(int around, bool histories) const {
  std::vector<int> all;
  for (int i = around + 1; i < static_cast<int>(states_.size()) && inside(i, around); ++i) {
    if (at(i).kind != Kind::region && (histories || at(i).kind != Kind::history)) all.push_back(i);
  }
  return all;
}

std::vector<int> RandomChart::targets(int around, bool histories) {
  const std::vector<int> all = candidates(around, histories);
  std::vector<int> chosen{all[static_cast<std::size_t>(below(static_cast<int>(all.size())))]};
  for (int tries = 0; chance(70) && tries < 4; ++tries) {
    const int further = all[static_cast<std::size_t>(below(static_cast<int>(all.size())))];
    if (std::ranges::all_of(chosen, [&](int one) { return together(one, further); })) chosen.push_back(further);
  }
  return chosen;
}

void RandomChart::choose_initials() {
  written_initial_.assign(states_.size(), false);
  for (int i = 0; i < static_cast<int>(states_.size()); ++i) {
    RefState& state = at(i);
    const auto number = static_cast<std::size_t>(i);
    if (state.kind == Kind::parallel && chance(40)) {  // says where regions begin
      written_initial_[number] = true;
      for (const int target : targets(i, false)) {
        int region = target;
        while (at(region).parent != i) region = at(region).parent;
        at(region).initial.push_back(target);
      }
    }
    const bool compound = state.kind == Kind::compound || state.kind == Kind::region;
    if (!compound || !state.initial.empty()) continue;
    std::vector<int> children;
    for (const int child : state.children) {
      if (at(child).kind != Kind::history) children.push_back(child);
    }
    written_initial_[number] = children.size() > 1 || chance(30);
    if (!written_initial_[number]) {
      state.initial = children;
    } else if (chance(60)) {
      state.initial = {children[static_cast<std::size_t>(below(static_cast<int>(children.size())))]};
    } else {
      state.initial = targets(i, true);
    }
  }
  for (int i = 0; i < static_cast<int>(states_.size()); ++i) {
    if (at(i).kind == Kind::history) choose_history(i);
  }
}

void RandomChart::choose_history(int history) {
  const int parent = at(history).parent;
  const RefState& around = at(parent);
  const bool needed = std::ranges::any_of(
      around.initial, [&](int one) { return at(one).kind == Kind::history && at(one).parent == parent; });
  if (needed || chance(50)) {
    written_initial_[static_cast<std::size_t>(history)] = true;
    at(history).initial = targets(parent, false);
  } else if (around.kind != Kind::parallel) {
    at(history).initial = around.initial;
  } else {
    std::ranges::copy_if(around.children, std::back_inserter(at(history).initial),
                         [&](int child) { return at(child).kind == Kind::region; });
  }
}

void RandomChart::add_transitions() {
  for (int i = 0; i < static_cast<int>(states_.size()); ++i) {
    const Kind kind = at(i).kind;
    if (kind == Kind::history || kind == Kind::final_state) continue;
    for (int count = below(kind == Kind::atomic ? 4 : 3); count > 0; --count) add_transition(i, false);
    if (chance(15)) add_transition(i, true);
  }
}

void RandomChart::add_transition(int source, bool always) {
  RefTransition made;
  made.number = transitions_++;
  made.source = source;
  made.always = always;
  if (chance(75)) made.targets = targets(0, true);
  const bool compound = at(source).kind == Kind::compound || at(source).kind == Kind::region;
  if (compound && chance(40)) {
    made.targets = targets(source, true);
    made.internal = chance(60);
  }
  if (chance(60)) {
    const int which = below(14);
    made.event = which < 7 ? names_of_events[which] : which < 10 ? patterns[which - 7] : which < 12 ? "done" : "lost";
  } else if (!always && chance(40)) {
    made.after_ms = 5 + 10 * below(5);
  }
  if (chance(made.event.empty() && made.after_ms < 0 ? 90 : 30)) made.guard = below(guards);
  at(source).transitions.push_back(made);
}

// What nobody waits for cannot be emitted.
void RandomChart::add_emits() {
  std::vector<std::string> all;
  for (const RefState& state : states_) {
    for (const RefTransition& one : state.transitions) {
      if (one.event.empty() || one.event == "done" || one.event == "lost") continue;
      all.push_back(one.event == "*"            ? "b"
                    : one.event.ends_with(".*") ? one.event.substr(0, one.event.size() - 1) + "p"
                                                : one.event);
    }
  }
  if (all.empty()) return;
  const auto any = [&] { return all[static_cast<std::size_t>(below(static_cast<int>(all.size())))]; };
  for (RefState& state : states_) {
    if (state.kind != Kind::history && chance(15)) state.emits = any();
    for (RefTransition& one : state.transitions) {
      if (chance(25)) one.emits = any();
    }
  }
}

std::vector<std::string> RandomChart::events_of_a_tick() {
  std::vector<std::string> all;
  for (int count = below(4); count > 0; --count) all.emplace_back(names_of_events[below(7)]);
  return all;
}

std::string RandomChart::path(int state) const {
  return at(state).parent <= 0 ? at(state).name : path(at(state).parent) + "." + at(state).name;
}

// By name, by whole path, or by the path from `from`.
std::string RandomChart::names(const std::vector<int>& targets, int from) const {
  std::string text;
  for (const int target : targets) {
    const bool relative = from > 0;
    const std::string name = relative                       ? path(target).substr(path(from).size() + 1)
                             : from == 0 || target % 3 == 0 ? path(target)
                                                            : at(target).name;
    text += (text.empty() ? "'" : ", '") + name + "'";
  }
  return targets.size() == 1 ? text : "{ " + text + " }";
}

void RandomChart::write(const RefTransition& one, std::string& text) const {
  text += "{ ";
  if (!one.event.empty()) text += "on = '" + one.event + "', ";
  if (one.after_ms >= 0) text += "after = " + std::to_string(one.after_ms) + " / 1000, ";
  if (one.guard >= 0) text += "when = when(" + std::to_string(one.guard) + "), ";
  if (!one.targets.empty()) text += "to = " + names(one.targets, -1) + ", ";
  if (one.internal) text += "internal = true, ";
  text += "action = does('!" + std::to_string(one.number) + "'" + (one.emits.empty() ? "" : ", '" + one.emits + "'") +
          ") },\n";
}

void RandomChart::write(int number, std::string& text) const {
  constexpr const char* words[] = {"state", "state", "parallel", "region", "final", "history"};
  const RefState& state = at(number);
  const auto place = static_cast<std::size_t>(number);
  if (number > 0) text += std::string("k.") + words[static_cast<int>(state.kind)] + " '" + state.name + "' {\n";
  if (state.kind == Kind::history) {
    text += state.deep ? "deep = true, " : "";
    if (written_initial_[place]) text += "to = " + names(state.initial, state.parent);
    text += "},\n";
    return;
  }
  text += "enter = does('+" + state.name + "'" + (state.emits.empty() ? "" : ", '" + state.emits + "'") + "),\n";
  if (state.kind == Kind::final_state) {
    text += "outcome = '" + state.outcome + "' },\n";
    return;
  }
  text += number == 0 ? "exit = over, during = tell,\n"
                      : "exit = does '-" + state.name + "', during = does '." + state.name + "',\n";
  if (written_initial_[place]) {
    std::vector<int> initial = state.initial;
    for (const int region : state.children) {
      if (state.kind != Kind::parallel || at(region).kind != Kind::region ||
          written_initial_[static_cast<std::size_t>(region)])
        continue;
      std::vector<int> children;
      std::ranges::copy_if(at(region).children, std::back_inserter(children),
                           [&](int child) { return at(child).kind != Kind::history; });
      if (at(region).initial != children)
        initial.insert(initial.end(), at(region).initial.begin(), at(region).initial.end());
    }
    if (!initial.empty()) text += "initial = " + names(initial, number) + ",\n";
  }
  std::string always;
  for (const RefTransition& one : state.transitions) write(one, one.always ? always : text);
  if (!always.empty()) text += "always = { " + always + "},\n";
  for (const int child : state.children) write(child, text);
  if (number > 0) text += "},\n";
}

std::string RandomChart::lua() const {
  std::string text =
      "local k = require 'kadans'\n"
      "local said = ''\n"
      "local function does(text, event)\n"
      "  return function(m) said = said .. text .. ' ' if event then m:emit(event) end end\n"
      "end\n"
      "local function tell() print(said) said = '' end\n"
      "local function over() said = said .. '-s0 ' tell() end\n"
      "local function when(n) return function(s) return (math.floor(s.time_s * 100 + 0.5) * 7 + n * 13) % 5 < 2 end "
      "end\n"
      "return k.behavior 'random' {\n";
  write(0, text);
  return text + "}\n";
}

}  // namespace kadans::script_test
