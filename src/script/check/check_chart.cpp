#include <algorithm>
#include <set>
#include <span>

#include "check_source.h"
#include "hint.h"
#include "kadans/signal/input_error.h"
#include "script/behavior/behavior_parts.h"
#include "script/chart/chart_reader.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

class ChartCheck {
 public:
  ChartCheck(const Chart& chart, std::vector<InputProblem>& problems)
      : chart_(chart), problems_(problems), reached_(chart.states.size(), false) {}

  void run() {
    find_reached();
    for (StateIndex i = 0; i < chart_.size(); ++i) {
      const Chart::State& state = chart_.states[i];
      never_entered(i);
      if (reached_[i] && state.kind != Chart::Kind::history) {
        no_way_out(i);
        shadowed(state, chart_.ordinary(state));
        shadowed(state, chart_.transitions_of(state).subspan(state.transition_count));
        run_done_without_run(i);
      }
      if (state.kind == Chart::Kind::final_state && !state.outcome_given) {
        problem(state, state.line, "final '" + state.name + "' does not say how it ended: outcome = \"done\"?");
      }
    }
  }

 private:
  void problem(const Chart::State& state, int line, std::string message) {
    problems_.push_back({state.chunk, line, 0, std::move(message)});
  }

  void find_reached() {
    enter(0);
    for (bool more = true; more;) {
      more = false;
      for (const Chart::Transition& transition : chart_.transitions) {
        if (!reached_[transition.source]) continue;
        transition.each_target([&](StateIndex target) {
          if (reached_[target]) return;
          enter(target);
          more = true;
        });
      }
    }
  }

  // The state, those around it, and what is entered with them.
  void enter(StateIndex index) {
    std::vector<StateIndex> waiting{index};
    while (!waiting.empty()) {
      const StateIndex at = waiting.back();
      waiting.pop_back();
      if (reached_[at]) continue;
      reached_[at] = true;
      const Chart::State& state = chart_.states[at];
      if (state.parent != no_state && !reached_[state.parent]) waiting.push_back(state.parent);
      // A transition past `initial` still makes the parent's default reachable only through the parent itself.
      if (at_entry(at, index)) waiting.insert(waiting.end(), state.defaults.begin(), state.defaults.end());
      chart_.each_child(at, [&](StateIndex child) {
        const bool called = chart_.states[child].machine_root && state.initial == no_state;
        if (state.kind == Chart::Kind::parallel || called) waiting.push_back(child);
      });
    }
  }

  // Whether entering `target` enters `at` by default, not on the way to something inside it.
  bool at_entry(StateIndex at, StateIndex target) const { return at == target || !chart_.inside(target, at); }

  void never_entered(StateIndex index) {
    const Chart::State& state = chart_.states[index];
    if (reached_[index] || state.parent == no_state || !reached_[state.parent]) return;
    problem(state, state.line,
            "state '" + state.name + "' is never entered: no transition leads to it, with to = \"" + state.name + "\"");
  }

  void no_way_out(StateIndex index) {
    const Chart::State& state = chart_.states[index];
    const bool leaf = state.end == index + 1;
    if (!leaf || state.kind == Chart::Kind::final_state || state.kind == Chart::Kind::parallel) return;
    for (StateIndex around = index; around != no_state; around = chart_.states[around].parent) {
      const Chart::State& at = chart_.states[around];
      if (at.endless) return;
      const auto leads = [](const Chart::Transition& one) { return one.target != no_state; };
      const auto elsewhere = [&](const Chart::Transition& one) { return leads(one) && one.target != index; };
      if (std::ranges::any_of(chart_.ordinary(at), leads)) return;
      if (std::ranges::any_of(chart_.transitions_of(at), elsewhere)) return;
    }
    const std::string shown = state.name.empty() ? chart_.name : state.name;
    problem(state, state.line, "state '" + shown + "' has no way out: give it a transition, or say endless = true");
  }

  void shadowed(const Chart::State& state, std::span<const Chart::Transition> all) {
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      const bool open = all[i].when != Chart::no_function || all[i].on != no_event || all[i].timed;
      if (open || all[i].target == no_state) continue;
      problem(state, all[i + 1].line,
              "this transition is never looked at: the one before it, to '" + all[i].target_names.front() +
                  "', is always taken");
      return;
    }
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        if (hides(all[i], all[k]))
          problem(state, all[k].line,
                  "this transition is never taken: the one in line " + std::to_string(all[i].line) + ", to '" +
                      all[i].target_names.front() + "', takes all that it could, and comes no later");
      }
    }
  }

  // Whether whatever takes the later one of a state has been taken by the first: the same event, or none, and no later.
  static bool hides(const Chart::Transition& first, const Chart::Transition& later) {
    if (first.when != Chart::no_function || first.target == no_state || first.on != later.on) return false;
    if (!first.timed) return true;
    if (!later.timed || first.after_parameter != later.after_parameter) return false;
    return first.after_parameter != Chart::no_parameter || first.after_s <= later.after_s;
  }

  void run_done_without_run(StateIndex index) {
    const Chart::State& state = chart_.states[index];
    for (const Chart::Transition& transition : chart_.ordinary(state)) {
      if (transition.on != run_done_event || state.run != Chart::no_function) continue;
      problem(state, transition.line,
              "state '" + state.name + "' waits for \"run.done\", but it has no run = function(m) ... end");
    }
  }

  const Chart& chart_;
  std::vector<InputProblem>& problems_;
  std::vector<bool> reached_;
};

// What the functions emit, as far as their text tells.
struct Emitted {
  std::set<std::string> events;
  std::set<std::string> beginnings;  // of those that are put together: "refused:" .. why
  bool unknown = false;              // one that only the run knows

  bool may_be(const std::string& event) const {
    return unknown || events.contains(event) ||
           std::ranges::any_of(beginnings, [&](const std::string& start) { return event.starts_with(start); });
  }
  // Whether one may be that this takes: "fault.*", or "*", which events from outside may mean, too.
  bool may_be_like(const std::string& pattern) const {
    const std::string words = pattern.substr(0, pattern.size() - 1);
    const auto fits = [&](const std::string& text) { return (text + ".").starts_with(words); };
    return unknown || words.empty() || std::ranges::any_of(events, fits) ||
           std::ranges::any_of(beginnings,
                               [&](const std::string& start) { return fits(start) || words.starts_with(start); });
  }
};

// The values that an argument may have, from `at` up to `end`: `a and "b" or "c"` is b or c.
void add_values(const Tokens& tokens, std::size_t at, std::size_t end, Emitted& emitted) {
  int depth = 0;
  std::size_t value = at;
  const auto take = [&](std::size_t from, std::size_t to) {
    const bool text = from < to && tokens[from].kind == TokenKind::text;
    if (text && to == from + 1) {
      emitted.events.insert(tokens[from].text);
    } else if (text && tokens[from + 1].is("..")) {
      emitted.beginnings.insert(tokens[from].text);
    } else {
      emitted.unknown = true;
    }
  };
  for (std::size_t i = at; i < end; ++i) {
    depth += opens(tokens[i]);
    if (depth != 0) continue;
    if (tokens[i].is("and")) value = i + 1;
    if (!tokens[i].is("or")) continue;
    take(value, i);
    value = i + 1;
  }
  take(value, end);
}

void add_emitted(const Tokens& tokens, Emitted& emitted) {
  for (std::size_t i = 1; i + 2 < tokens.size(); ++i) {
    const bool name = tokens[i].kind == TokenKind::name || tokens[i].kind == TokenKind::text;
    const bool field = name && (tokens[i - 1].is("{") || tokens[i - 1].is(",")) && tokens[i + 1].is("=");
    if (field && tokens[i].text == "event") {  // of m:on
      const bool text = tokens[i + 2].kind == TokenKind::text;
      emitted.unknown = emitted.unknown || !text;
      if (text) emitted.events.insert(tokens[i + 2].text);
    }
    if (!name || tokens[i].text != "emit") continue;
    const bool method = tokens[i].kind == TokenKind::name && tokens[i - 1].is(":");
    if (method && tokens[i + 1].kind == TokenKind::text) {
      emitted.events.insert(tokens[i + 1].text);
    } else if (method && tokens[i + 1].is("(")) {
      add_values(tokens, i + 2, end_of_call(tokens, i + 2) - 1, emitted);
    } else {
      emitted.unknown = true;  // m.emit as a value, m["emit"]
    }
  }
}

// The names with which states may end, as far as the chart tells.
using Ends = std::set<std::string>;

Ends own_ends(const Chart& chart, StateIndex index);

// All regions must end; it is done when all of them are.
Ends ends_of_parallel(const Chart& chart, StateIndex index) {
  Ends all;
  bool each_ends = true, each_done = true;
  chart.each_region(index, [&](StateIndex region) {
    Ends its = own_ends(chart, region);
    each_ends = each_ends && !its.empty();
    each_done = each_done && its.contains("done");
    all.merge(its);
  });
  if (!each_ends) return {};
  if (!each_done) all.erase("done");
  return all;
}

Ends own_ends(const Chart& chart, StateIndex index) {
  if (chart.states[index].kind == Chart::Kind::parallel) return ends_of_parallel(chart, index);
  Ends ends;
  chart.each_child(index, [&](StateIndex child) {
    const Chart::State& inside = chart.states[child];
    if (inside.kind == Chart::Kind::final_state) ends.insert(inside.outcome_name);
    if (!inside.machine_root) return;
    ends.merge(own_ends(chart, child));
    ends.insert({"done", "failed"});  // it may end so tomorrow: waiting for that is foresight
  });
  return ends;
}

// Its own ends, and those of states inside that reach it.
Ends heard_ends(const Chart& chart, StateIndex index) {
  Ends ends = own_ends(chart, index);
  chart.each_child(index, [&](StateIndex child) {
    const bool within = !chart.states[child].machine_root && chart.states[child].kind != Chart::Kind::region;
    if (within) ends.merge(heard_ends(chart, child));
  });
  return ends;
}

std::vector<std::string> waited_for(const Chart& chart) {
  std::set<std::string> names;
  for (const Chart::Transition& transition : chart.transitions) {
    const bool sent = transition.on != no_event && !chart.made_by_runner(transition.on);
    if (sent) names.insert(chart.events[static_cast<std::size_t>(transition.on)]);
  }
  return {names.begin(), names.end()};
}

bool waits_for(const Chart& chart, const ScriptEvent& event) {
  const EventId id = chart.find_event(event.name);
  return std::ranges::find(chart.transitions, id, &Chart::Transition::on) != chart.transitions.end() ||
         chart.any_pattern_takes(event.name);
}

// Declared where a behavior is. What a module declares is for several behaviors, which need not wait for all of it.
bool is_own(const Chart& chart, const ScriptEvent& event) {
  return std::ranges::any_of(
      chart.machines, [&](const Chart::Machine& machine) { return chart.states[machine.root].chunk == event.chunk; });
}

struct Looking {
  Behavior::Parts& parts;
  std::vector<InputProblem>& problems;
  std::string chunk{};
  int line = 0;  // where the table is declared, or after it
};

void tell(Looking& looking, const std::string& path, const std::string& key, const std::string& what) {
  const int line = looking.parts.lua->line_of(looking.chunk, looking.line, key);
  looking.problems.push_back({looking.chunk, line, 0, path + what + ": vars and args hold plain data"});
}

// [-0 +0] The value at the top. Nothing here raises but for want of memory.
void look_into(lua_State* state, Looking& looking, const std::string& path, const std::string& key, int depth) {
  const int type = lua_type(state, -1);
  if (to_parameter(state, -1) != nullptr)
    return tell(looking, path, key, " is a parameter, which is read where it is needed");
  if (type == LUA_TFUNCTION || type == LUA_TUSERDATA || type == LUA_TTHREAD)
    return tell(looking, path, key, std::string(" is a ") + lua_typename(state, type));
  if (type != LUA_TTABLE) return;
  if (depth > vars_depth_max) return tell(looking, path, key, " is nested too deeply, or holds itself");
  luaL_checkstack(state, 6, "vars");
  const int table = lua_gettop(state);
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) {
    const std::string name = lua_type(state, -2) == LUA_TSTRING   ? lua_tostring(state, -2)
                             : lua_type(state, -2) == LUA_TNUMBER ? std::to_string(lua_tointeger(state, -2))
                                                                  : "?";
    const std::size_t known = looking.problems.size();
    look_into(state, looking, path + "." + name, name, depth + 1);
    if (depth > 1 && looking.problems.size() > known) break;  // one of a nested table: it may hold itself
  }
  lua_settop(state, table);
}

void look_at(lua_State* state, Looking& looking, int reference, const char* name) {
  if (reference == Chart::no_function) return;
  lua_rawgeti(state, LUA_REGISTRYINDEX, reference);
  look_into(state, looking, name, name, 0);
  lua_pop(state, 1);
}

void look_at_defaults(lua_State* state, Looking& looking, int declared) {
  if (declared == Chart::no_function) return;
  lua_rawgeti(state, LUA_REGISTRYINDEX, declared);
  const int all = lua_gettop(state);
  for (lua_pushnil(state); lua_next(state, all) != 0; lua_pop(state, 2)) {
    lua_rawgeti(state, -1, 1);
    const std::string name = lua_tostring(state, all + 1);
    look_into(state, looking, "args." + name, name, 1);
  }
  lua_settop(state, all - 1);
}

void look(lua_State* state, Looking& looking) {
  const Chart& chart = looking.parts.chart;
  for (const Chart::Machine& machine : chart.machines) {
    looking.chunk = chart.states[machine.root].chunk;
    looking.line = chart.states[machine.root].line;
    look_at(state, looking, machine.vars, "vars");
    look_at_defaults(state, looking, machine.arguments);
    looking.chunk = machine.call_chunk;
    looking.line = machine.call_line;
    if (!machine.call_chunk.empty()) look_at(state, looking, machine.given, "args");
  }
}

// What comes with the events that the runner makes.
constexpr const char* runner_fields[] = {"message", "file",  "line",  "cause", "state",  "reason",
                                         "what",    "joint", "value", "limit", "result", "results"};

// s.event.data.NAME, where no event that is declared has such a field, and one has nearly.
void check_event_fields(const std::vector<ScriptEvent>& declared, const ReadSource& read,
                        std::vector<InputProblem>& problems) {
  std::vector<std::string> known;
  for (const ScriptEvent& event : declared) {
    for (const ScriptEvent::Field& field : event.fields) known.push_back(field.name);
  }
  if (known.empty()) return;
  known.insert(known.end(), std::begin(runner_fields), std::end(runner_fields));
  const Tokens& tokens = read.scopes.tokens();
  for (std::size_t i = 4; i < tokens.size(); ++i) {
    const bool path = tokens[i - 4].text == "event" && tokens[i - 3].is(".") && tokens[i - 2].text == "data" &&
                      tokens[i - 1].is(".") && tokens[i].kind == TokenKind::name;
    if (!path || std::ranges::find(known, tokens[i].text) != known.end()) continue;
    const std::string hint = hint_text(tokens[i].text, known);
    if (!hint.empty())
      problems.push_back(
          {read.source->chunk, tokens[i].line, 0, "no event here has the field '" + tokens[i].text + "'" + hint});
  }
}

}  // namespace

void check_chart(const Chart& chart, std::vector<InputProblem>& problems) { ChartCheck(chart, problems).run(); }

void check_events(const Chart& chart, const std::vector<ScriptEvent>& declared, const std::vector<ReadSource>& read,
                  std::vector<InputProblem>& problems) {
  Emitted emitted;
  for (const ReadSource& one : read) {
    add_emitted(one.scopes.tokens(), emitted);
    check_event_fields(declared, one, problems);
  }
  for (const ScriptEvent& event : declared) {
    if (!waits_for(chart, event) && !emitted.may_be(event.name) && is_own(chart, event))
      problems.push_back({event.chunk, event.line, 0,
                          "the event '" + event.name + "' is declared, but no transition waits for it" +
                              hint_text(event.name, waited_for(chart))});
  }
  for (const ScriptEvent& event : declared) emitted.events.insert(event.name);
  for (const Chart::Transition& transition : chart.transitions) {
    if (transition.on == no_event || transition.on == run_done_event || chart.is_report(transition.on)) continue;
    const std::string& event = chart.events[static_cast<std::size_t>(transition.on)];
    const bool pattern = transition.pattern >= 0, end = !pattern && chart.made_by_runner(transition.on);
    const bool fault = std::ranges::any_of(
        chart.fault_events, [&](const auto& one) { return chart.takes_by_pattern(transition, one.second); });
    if (fault) continue;
    if (pattern ? emitted.may_be_like(event) : !end && emitted.may_be(event)) continue;
    Ends ends = heard_ends(chart, transition.source);
    if (ends.contains(event)) continue;
    if (!end) ends.insert(emitted.events.begin(), emitted.events.end());
    if (chart.states[transition.source].run != Chart::no_function) ends.insert("run.done");
    const Chart::State& source = chart.states[transition.source];
    const std::string told =
        end ? "nothing in '" + (source.name.empty() ? chart.name : source.name) + "' ends with '" + event + "'"
            : std::string(pattern ? "nobody emits an event like '" : "nobody emits the event '") + event + "' here";
    problems.push_back({source.chunk, transition.line, 0,
                        told + (event.find_first_of(", |") == std::string::npos
                                    ? hint_text(event, {ends.begin(), ends.end()})
                                    : std::string(": several are a list: on = { \"a\", \"b\" }"))});
  }
}

void check_vars(Behavior::Parts& parts, std::vector<InputProblem>& problems) {
  Looking looking{parts, problems};
  parts.lua->call_or_throw([&](lua_State* state) { look(state, looking); }, parts.settings.limits.load_instructions, 0);
}

}  // namespace kadans
