#include "chart_reader.h"

#include <algorithm>
#include <map>
#include <string>

#include "chart_nodes.h"
#include "script/check/source_lexer.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

constexpr std::size_t states_max = 4000, transitions_max = 16000;  // what a chart takes is not the script's memory
constexpr std::size_t key_text_max = 256;
constexpr int call_depth_max = 16;

// Nothing here may hold what needs a destructor while it calls Lua: strings go straight into the chart.
struct Reader {
  lua_State* state;
  Chart& chart;

  int reference(int table, const char* key) const {
    lua_getfield(state, table, key);
    if (lua_isnil(state, -1)) return lua_pop(state, 1), Chart::no_function;
    return luaL_ref(state, LUA_REGISTRYINDEX);
  }
  const char* text(int table, const char* key) const {  // anchored by the table
    lua_getfield(state, table, key);
    const char* value = lua_tostring(state, -1);
    if (value != nullptr && lua_objlen(state, -1) > key_text_max) luaL_error(state, "'%s' is too long", key);
    lua_pop(state, 1);
    return value != nullptr ? value : "";
  }

  // Both look through what is there already.
  int find_line(const ScriptPlace& place, const char* text) const {
    const LuaState& owner = *core_of(state).owner;
    core_of(state).budget.charge(state, owner.search_instructions(place.chunk));
    return owner.line_of(place.chunk, place.line, text);
  }
  EventId intern(const char* event) const {
    core_of(state).budget.charge(state, static_cast<double>(chart.events.size()));
    return chart.intern(event);
  }

  void read_transition(int table, StateIndex source, const ScriptPlace& place) {
    if (chart.transitions.size() >= transitions_max)
      raise_at(state, place, nullptr, "more than %d transitions", static_cast<int>(transitions_max));
    Chart::Transition& made = chart.transitions.emplace_back();
    made.source = source;
    made.target_name = text(table, "to");
    made.line = find_line(place, made.target_name.c_str());
    made.when = reference(table, "when");
    made.action = reference(table, "action");
    const char* on = text(table, "on");
    if (*on != '\0') made.on = intern(on);
    lua_getfield(state, table, "after");
    std::size_t number = 0;
    made.timed = !lua_isnil(state, -1);
    if (is_parameter(state, -1, &number)) {
      made.after_parameter = static_cast<std::int32_t>(number);
    } else if (made.timed) {
      made.after_s = lua_tonumber(state, -1);
    }
    lua_pop(state, 1);
    made.why = text(table, "why");
    if (made.why.empty()) made.why = *on != '\0' ? on : made.timed ? "after" : "when";
  }

  // The transitions in the list at `list`, nodes passed over.
  std::uint16_t read_transitions(int list, StateIndex source, const ScriptPlace& place) {
    const std::size_t before = chart.transitions.size();
    const int count = static_cast<int>(lua_objlen(state, list));
    for (int i = 1; i <= count; ++i) {
      lua_rawgeti(state, list, i);
      NodeKind kind{};
      if (!is_node(state, -1, &kind)) read_transition(lua_gettop(state), source, place);
      lua_pop(state, 1);
    }
    return static_cast<std::uint16_t>(chart.transitions.size() - before);
  }

  StateIndex add_state(const char* name, Chart::Kind kind, StateIndex parent, std::uint16_t machine,
                       const ScriptPlace& place) {
    if (chart.states.size() >= states_max)
      raise_at(state, place, nullptr, "more than %d states", static_cast<int>(states_max));
    const auto index = static_cast<StateIndex>(chart.states.size());
    Chart::State& made = chart.states.emplace_back();
    made.name = name;
    made.kind = kind;
    made.parent = parent;
    made.machine = machine;
    made.chunk = place.chunk;
    made.line = place.line;
    if (parent != no_state) {
      const std::string& above = chart.states[parent].path;
      made.path = above.empty() ? made.name : above + "." + made.name;
    }
    return index;
  }

  void read_body(int body, StateIndex index, const ScriptPlace& place, int depth) {
    {
      Chart::State& made = chart.states[index];
      made.enter = reference(body, "enter");
      made.exit = reference(body, "exit");
      made.during = reference(body, "during");
      made.run = reference(body, "run");
      made.initial_name = text(body, made.kind == Chart::Kind::history ? "to" : "initial");
      made.outcome_name = text(body, "outcome");
      if (made.kind == Chart::Kind::final_state) {
        made.outcome_given = !made.outcome_name.empty();
        if (made.outcome_name.empty()) made.outcome_name = "done";
        made.outcome = intern(made.outcome_name.c_str());
      }
      lua_getfield(state, body, "deep");
      made.deep = lua_toboolean(state, -1) != 0;
      lua_getfield(state, body, "endless");
      made.endless = lua_toboolean(state, -1) != 0;
      made.first_transition = static_cast<std::uint16_t>(chart.transitions.size());
    }
    const std::uint16_t transitions = read_transitions(body, index, place);
    chart.states[index].transition_count = transitions;
    chart.states[index].first_always = static_cast<std::uint16_t>(chart.transitions.size());
    lua_getfield(state, body, "always");
    if (lua_istable(state, -1)) {
      const std::uint16_t always = read_transitions(lua_gettop(state), index, place);
      chart.states[index].always_count = always;
    }
    lua_settop(state, body);
    read_children(body, index, depth);
    chart.states[index].end = static_cast<StateIndex>(chart.states.size());
  }

  void read_children(int body, StateIndex index, int depth) {
    luaL_checkstack(state, 20, "states are nested too deeply");
    const int count = static_cast<int>(lua_objlen(state, body));
    for (int i = 1; i <= count; ++i) {
      lua_rawgeti(state, body, i);
      NodeKind kind{};
      if (is_node(state, -1, &kind)) read_node(lua_gettop(state), kind, index, depth);
      lua_settop(state, body);
    }
  }

  void read_node(int node, NodeKind kind, StateIndex parent, int depth) {
    const ScriptPlace place = node_place(state, node);
    const char* name = node_name(state, node);
    if (kind == NodeKind::call) return read_call(node, name, parent, place, depth);
    if (kind == NodeKind::behavior)
      raise_at(state, place, nullptr, "a behavior inside a behavior: k.call \"%s\" does that", name);
    constexpr Chart::Kind kinds[] = {Chart::Kind::state,  Chart::Kind::state,       Chart::Kind::parallel,
                                     Chart::Kind::region, Chart::Kind::final_state, Chart::Kind::history};
    const StateIndex index =
        add_state(name, kinds[static_cast<int>(kind)], parent, chart.states[parent].machine, place);
    push_node_body(state, node);
    read_body(lua_gettop(state), index, place, depth);
  }

  // [-0 +0] Grafts the behavior that is called in below `parent`.
  void read_call(int node, const char* name, StateIndex parent, const ScriptPlace& place, int depth) {
    if (depth >= call_depth_max)
      raise_at(state, place, name, "behaviors call each other too deeply; does '%s' call itself?", name);
    lua_pushcfunction(state, sandbox_require);
    lua_pushstring(state, name);
    if (lua_pcall(state, 1, 1, 0) != 0) {
      core_of(state).budget.raise_again(state);
      const char* text = lua_tostring(state, -1);
      if (text != nullptr && text[0] != 'n') lua_error(state);  // the file has its own mistake, with its own place
      raise_at(state, place, name, "k.call: %s", text != nullptr ? text : "?");
    }
    const int behavior = lua_gettop(state);
    NodeKind kind{};
    if (!is_node(state, behavior, &kind) || kind != NodeKind::behavior) {
      raise_at(state, place, name, "k.call: '%s' does not return a k.behavior", name);
    }
    push_node_body(state, node);
    check_arguments(behavior, lua_gettop(state), name, place);
    const int given = luaL_ref(state, LUA_REGISTRYINDEX);
    const std::size_t number = chart.machines.size();
    read_machine(behavior, parent, given, depth + 1);
    chart.machines[number].call_chunk = place.chunk;
    chart.machines[number].call_line = place.line;
  }

  void check_arguments(int behavior, int given, const char* name, const ScriptPlace& place) const {
    push_node_body(state, behavior);
    lua_getfield(state, -1, "args");
    for (lua_pushnil(state); lua_next(state, given) != 0; lua_pop(state, 1)) {
      const char* key = lua_type(state, -2) == LUA_TSTRING ? lua_tostring(state, -2) : "?";
      bool known = lua_istable(state, given + 2);
      if (known) {
        lua_getfield(state, given + 2, key);
        known = !lua_isnil(state, -1);
        lua_pop(state, 1);
      }
      if (!known) raise_at(state, place, key, "behavior '%s' takes no argument '%s'", name, key);
    }
    lua_settop(state, given);
  }

  StateIndex read_machine(int behavior, StateIndex parent, int given, int depth) {
    const ScriptPlace place = node_place(state, behavior);
    const char* name = node_name(state, behavior);
    const auto number = static_cast<std::uint16_t>(chart.machines.size());
    chart.machines.emplace_back();
    const StateIndex index = add_state(parent == no_state ? "" : name, Chart::Kind::state, parent, number, place);
    chart.states[index].machine_root = true;
    push_node_body(state, behavior);
    const int body = lua_gettop(state);
    Chart::Machine& machine = chart.machines[number];
    machine.name = name;
    machine.root = index;
    machine.controls = text(body, "controls");
    machine.vars = reference(body, "vars");
    machine.arguments = reference(body, "args");
    machine.migrate = reference(body, "migrate");
    machine.given = given;
    lua_getfield(state, body, "version");
    machine.version = static_cast<int>(lua_tointeger(state, -1));
    lua_settop(state, body);
    read_body(body, index, place, depth);
    return index;
  }
};

// Every transition looks for its state, every state for its lines; both by going through all.
void charge_resolving(lua_State* state, const Chart& chart) {
  constexpr double looks_per_instruction = 16, bytes_per_instruction = 64;
  double source_bytes = 0;
  for (const LuaState::Source& source : core_of(state).owner->sources())
    source_bytes += static_cast<double>(source.text.size());
  const auto states = static_cast<double>(chart.states.size()),
             transitions = static_cast<double>(chart.transitions.size());
  core_of(state).budget.charge(state, states * (states + transitions) / looks_per_instruction);
  core_of(state).budget.charge(state, states * source_bytes / bytes_per_instruction);
}

using Tokens = std::vector<SourceToken>;

// The opening brace of `k.state "name" {` from this line on; 0: not written so.
std::size_t body_of(const Tokens& tokens, int line, const std::string& name) {
  const auto first = std::ranges::lower_bound(tokens, line, {}, &SourceToken::line);
  for (auto i = static_cast<std::size_t>(first - tokens.begin()); i + 2 < tokens.size(); ++i) {
    if (tokens[i].kind != SourceToken::Kind::text || tokens[i].text != name) continue;
    const std::size_t behind = tokens[i + 1].is(")") ? i + 2 : i + 1;
    if (tokens[behind].is("{")) return behind;
  }
  return 0;
}

// Of the transition { ... to = "name" ... } at `at`; 0 when it is none.
std::size_t target_of(const Tokens& tokens, std::size_t at) {
  if (!tokens[at].is("{")) return 0;
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    if (tokens[part].kind != SourceToken::Kind::name || tokens[part].text != "to") continue;
    return tokens[part + 1].is("=") && tokens[part + 2].kind == SourceToken::Kind::text ? part + 2 : 0;
  }
  return 0;
}

// Gives the transitions from `first` on their lines, those written in the braces at `at`, in their order.
void place(const Tokens& tokens, std::size_t at, Chart& chart, std::uint16_t first, std::uint16_t count) {
  std::vector<bool> placed(count, false);
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    const std::size_t target = target_of(tokens, part);
    for (std::uint16_t i = 0; target != 0 && i < count; ++i) {
      Chart::Transition& transition = chart.transitions[static_cast<std::size_t>(first + i)];
      if (placed[i] || transition.target_name != tokens[target].text) continue;
      placed[i] = true;
      transition.line = tokens[target].line;
      break;
    }
  }
}

std::size_t always_of(const Tokens& tokens, std::size_t at) {
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    const bool found = tokens[part].kind == SourceToken::Kind::name && tokens[part].text == "always" &&
                       tokens[part + 1].is("=") && tokens[part + 2].is("{");
    if (found) return part + 2;
  }
  return 0;
}

}  // namespace

void read_chart(lua_State* state, int index, Chart& chart) {
  Reader reader{state, chart};
  chart.name = node_name(state, index);
  reader.read_machine(index, no_state, Chart::no_function, 0);
  charge_resolving(state, chart);
}

void find_transition_lines(const std::vector<LuaState::Source>& sources, Chart& chart) {
  std::map<std::string, Tokens> files;
  for (const Chart::State& state : chart.states) {
    if (state.transition_count == 0 && state.always_count == 0) continue;
    auto file = files.find(state.chunk);
    for (const LuaState::Source& source : sources) {
      if (file == files.end() && source.chunk == state.chunk)
        file = files.emplace(state.chunk, lex_source(source.text)).first;
    }
    if (file == files.end()) continue;
    const Tokens& tokens = file->second;
    const std::string& name = state.machine_root ? chart.machines[state.machine].name : state.name;
    const std::size_t body = body_of(tokens, state.line, name);
    if (body == 0) continue;
    place(tokens, body, chart, state.first_transition, state.transition_count);
    const std::size_t always = state.always_count > 0 ? always_of(tokens, body) : 0;
    if (always != 0) place(tokens, always, chart, state.first_always, state.always_count);
  }
}

}  // namespace kadans
