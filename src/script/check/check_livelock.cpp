// Finds states that follow each other for ever without taking time: by transitions without a condition, with `after =
// 0`, with the same condition on all of them, or for events that the states emit when they are entered. What it cannot
// see is told when it happens (ChartRunner).
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <lua.hpp>

#include "check_source.h"
#include "script/behavior/behavior_parts.h"

namespace kadans {
namespace {

void read_chart_functions(lua_State* state, ChartFunctions& reading) {
  const auto read = [&](int reference) {
    if (reference == Chart::no_function) return;
    lua_Debug function;
    lua_rawgeti(state, LUA_REGISTRYINDEX, reference);
    const void* identity = lua_topointer(state, -1);
    if (lua_getinfo(state, ">S", &function) == 0 || function.source[0] != '@') return;
    reading.by_reference[reference] = {identity, function.source + 1, function.linedefined};
  };
  for (const Chart::State& one : reading.chart.states) read(one.enter);
  for (const Chart::Transition& one : reading.chart.transitions) read(one.when), read(one.action);
}

class LivelockCheck {
 public:
  LivelockCheck(const Behavior::Parts& parts, const ChartFunctions& functions, std::vector<InputProblem>& problems)
      : chart_(parts.chart), functions_(functions), problems_(problems) {}

  // Each transition is followed by at most one other for sure, so each circle is found by going on from all of them.
  void run() {
    std::vector<int> seen(chart_.transitions.size(), 0);
    for (std::size_t start = 0; start < chart_.transitions.size(); ++start) {
      std::optional<std::size_t> at = start;
      while (at && seen[*at] == 0) {
        seen[*at] = static_cast<int>(start) + 1;
        at = next(*at);
      }
      if (at && seen[*at] == static_cast<int>(start) + 1) tell(*at);
    }
  }

 private:
  // The first token behind the arguments.
  static std::size_t body_at(const Tokens& tokens, std::size_t function) {
    while (!tokens[function].is(")") && tokens[function].kind != TokenKind::end) ++function;
    return function + 1;
  }

  const ChartFunction* function_of(int reference) const {
    const auto found = functions_.by_reference.find(reference);
    return found == functions_.by_reference.end() ? nullptr : &found->second;
  }

  // function(...) return true end
  bool always_true(int reference) const {
    const ChartFunction* function = function_of(reference);
    if (function == nullptr) return false;
    const auto& [tokens, at] = functions_.begin_of(*function);
    if (at == 0) return false;
    const std::size_t body = body_at(tokens, at);
    return body + 2 < tokens.size() && tokens[body].is("return") && tokens[body + 1].is("true") &&
           tokens[body + 2].is("end");
  }

  // What a function emits whenever it is called: m:emit "name" outside of all branches and loops.
  void add_emitted_for_sure(int reference, std::set<EventId>& events) const {
    const ChartFunction* function = function_of(reference);
    if (function == nullptr) return;
    const auto& [tokens, at] = functions_.begin_of(*function);
    if (at == 0) return;
    int depth = 0;
    for (std::size_t i = body_at(tokens, at); i + 2 < tokens.size() && depth >= 0; ++i) {
      depth += opens_block(tokens[i]);
      if (depth != 0 || !tokens[i].is(":") || tokens[i + 1].text != "emit") continue;
      const std::size_t text = tokens[i + 2].is("(") ? i + 3 : i + 2;
      if (tokens[text].kind != TokenKind::text) continue;
      const EventId event = chart_.find_event(tokens[text].text);
      if (event != no_event) events.insert(event);
    }
  }

  // Whether a guard looks at m, its second argument: the time in the state, vars and set-points change with the state.
  // A function that cannot be read may.
  bool looks_at_machine(const ChartFunction& function) const {
    const auto& [tokens, at] = functions_.begin_of(function);
    if (at == 0) return true;
    std::size_t open = at;
    while (!tokens[open].is("(") && tokens[open].kind != TokenKind::end) ++open;
    if (open + 3 >= tokens.size() || !tokens[open + 2].is(",")) return false;
    const std::string& machine = tokens[open + 3].text;
    const auto begin = tokens.begin() + static_cast<std::ptrdiff_t>(open) + 4;
    const auto end = tokens.begin() + static_cast<std::ptrdiff_t>(end_of_block(tokens, at));
    return std::any_of(begin, end, [&](const SourceToken& token) { return token.is_name(machine); });
  }

  // The innermost state that is entered through `target`; no_state when there are several, or a history decides.
  StateIndex leaf_of(StateIndex target) const {
    while (target != no_state) {
      const Chart::State& state = chart_.states[target];
      if (state.kind == Chart::Kind::parallel || state.kind == Chart::Kind::history) return no_state;
      if (state.end == target + 1) return target;
      if (state.defaults.size() != 1) return no_state;
      target = state.defaults.front();
    }
    return no_state;
  }

  static bool takes_no_time(const Chart::Transition& one) {
    return !one.timed || (one.after_parameter == Chart::no_parameter && one.after_s <= 0);
  }

  // The transition that surely comes next, in this tick or the one after it.
  std::optional<std::size_t> next(std::size_t number) const {
    const Chart::Transition& taken = chart_.transitions[number];
    const StateIndex leaf = taken.also.empty() ? leaf_of(taken.target) : no_state;
    if (leaf == no_state) return std::nullopt;
    std::set<EventId> events;
    add_emitted_for_sure(taken.action, events);
    for (StateIndex at = leaf; at != no_state && at >= taken.target; at = chart_.states[at].parent)
      add_emitted_for_sure(chart_.states[at].enter, events);
    for (StateIndex at = leaf; at != no_state; at = chart_.states[at].parent) {
      const Chart::State& state = chart_.states[at];
      for (const auto& [first, count] : {std::pair{state.first_always, state.always_count},
                                         std::pair{state.first_transition, state.transition_count}}) {
        if (const auto found = first_of(first, count, events)) return found;
        if (count > 0) return std::nullopt;  // something else may come first
      }
    }
    return std::nullopt;
  }

  std::optional<std::size_t> first_of(std::size_t first, std::size_t count, const std::set<EventId>& events) const {
    for (std::size_t i = first; i < first + count; ++i) {
      const Chart::Transition& one = chart_.transitions[i];
      const auto takes = [&](EventId event) { return event == one.on || chart_.takes_by_pattern(one, event); };
      const bool open = one.target != no_state && one.when == Chart::no_function && takes_no_time(one);
      if (open && std::ranges::any_of(events, takes)) return i;
    }
    for (std::size_t i = first; i < first + count; ++i) {
      const Chart::Transition& one = chart_.transitions[i];
      if (one.target == no_state) continue;
      return takes_no_time(one) && one.on == no_event ? std::optional(i) : std::nullopt;
    }
    return std::nullopt;
  }

  void tell(std::size_t start) {
    std::vector<std::size_t> circle{start};
    for (auto at = next(start); at && *at != start; at = next(*at)) circle.push_back(*at);
    std::rotate(circle.begin(), std::ranges::min_element(circle), circle.end());
    std::set<const void*> conditions;  // nullptr: none
    for (const std::size_t number : circle) {
      const int when = chart_.transitions[number].when;
      const ChartFunction* function = always_true(when) ? nullptr : function_of(when);
      if (function != nullptr && looks_at_machine(*function)) return;
      conditions.insert(function == nullptr ? nullptr : function->identity);
    }
    const bool held = !conditions.contains(nullptr);
    if (conditions.size() > 1 || (held && circle.size() == 1)) return;
    std::string names;
    for (const std::size_t number : circle) {
      const StateIndex leaf = leaf_of(chart_.transitions[number].target);
      names += (names.empty() ? "'" : number == circle.back() ? " and '" : ", '") + chart_.states[leaf].path + "'";
    }
    const Chart::Transition& first = chart_.transitions[circle.front()];
    const std::string what = circle.size() == 1 ? "state " + names + " leads to itself and takes"
                                                : "states " + names + " lead to each other and take";
    problems_.push_back({chart_.states[first.source].chunk, first.line, 0,
                         what + " no time" + (held ? " while their condition holds" : "") +
                             ": give one of these transitions a condition of its own, an event or after > 0"});
  }

  const Chart& chart_;
  const ChartFunctions& functions_;
  std::vector<InputProblem>& problems_;
};

}  // namespace

ChartFunctions chart_functions(Behavior::Parts& parts) {
  ChartFunctions functions{parts.chart};
  for (const LuaState::Source& source : parts.lua->sources()) {
    Tokens& tokens = functions.files[source.chunk] = lex_source(source.text);
    tokens.resize(tokens.size() + 8, {.line = 0});
  }
  functions.known = parts.lua->call([&](lua_State* state) { read_chart_functions(state, functions); },
                                    parts.settings.limits.load_instructions, 0);
  return functions;
}

ChartFunctions::Begin ChartFunctions::begin_of(const ChartFunction& function) const {
  static const Tokens nothing;
  const auto file = files.find(function.chunk);
  Begin begin{file == files.end() ? nothing : file->second, 0};
  for (std::size_t i = 0; i < begin.tokens.size(); ++i) {
    if (begin.tokens[i].line != function.line || !begin.tokens[i].is("function")) continue;
    if (begin.at != 0) return {begin.tokens, 0};
    begin.at = i;
  }
  return begin;
}

void check_livelocks(Behavior::Parts& parts, std::vector<InputProblem>& problems) {
  const ChartFunctions functions = chart_functions(parts);
  if (functions.known) LivelockCheck(parts, functions, problems).run();
}

}  // namespace kadans
