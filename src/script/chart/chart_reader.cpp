#include "chart_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>

#include "chart_arguments.h"
#include "chart_calls.h"
#include "kadans/signal/capacity.h"
#include "kadans/signal/nearest_name.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

const HandleKey node_key = 0;
constexpr std::size_t listed_max = 32;                // events in one on = { ... }
constexpr std::size_t name_max = 64, text_max = 256;  // characters: charts keep them outside the script's memory

constexpr double node_instructions = 300, transition_instructions = 160;  // to check one

constexpr const char* behavior_keys[] = {"version", "controls", "vars",   "args", "migrate", "initial", "always",
                                         "enter",   "exit",     "during", "run",  "endless", nullptr};
constexpr const char* decisions_keys[] = {"version", "vars", "args",   "migrate", "initial", "always",
                                          "enter",   "exit", "during", "run",     "endless", nullptr};
constexpr const char* state_keys[] = {"controls", "initial", "enter",   "exit", "during",
                                      "run",      "always",  "endless", nullptr};
constexpr const char* parallel_keys[] = {"controls", "initial", "enter", "exit", "during", "run", "always", nullptr};
constexpr const char* final_keys[] = {"outcome", "result", "enter", nullptr};
constexpr const char* history_keys[] = {"deep", "to", nullptr};
constexpr const char* transition_keys[] = {"when", "on", "after", "to", "why", "action", "internal", nullptr};

struct NodeWords {
  const char* word;
  const char* const* keys;
};
constexpr NodeWords node_words[] = {  // as NodeKind
    {"k.behavior", behavior_keys}, {"k.state", state_keys},        {"k.parallel", parallel_keys},
    {"k.region", state_keys},      {"k.final", final_keys},        {"k.history", history_keys},
    {"k.call", state_keys},        {"k.decisions", decisions_keys}};
static_assert(std::size(node_words) == static_cast<std::size_t>(NodeKind::decisions) + 1);

const char* const* keys_of(NodeKind kind) noexcept { return node_words[static_cast<std::size_t>(kind)].keys; }

// The types that keys must have, in words of lua_typename. Other keys are checked elsewhere.
struct KeyType {
  std::string_view key;
  const char* type;
};
constexpr KeyType key_types[] = {{"enter", "function"},  {"exit", "function"},   {"during", "function"},
                                 {"run", "function"},    {"when", "function"},   {"migrate", "function"},
                                 {"action", "function"}, {"result", "function"}, {"outcome", "string"},
                                 {"why", "string"},      {"version", "number"},  {"vars", "table"},
                                 {"args", "table"},      {"always", "table"},    {"deep", "boolean"},
                                 {"endless", "boolean"}, {"internal", "boolean"}};

// Raises when the value at the top is a text that is too long.
void check_text_length(lua_State* state, const ScriptPlace& place, const char* key) {
  if (lua_type(state, -1) == LUA_TSTRING && lua_objlen(state, -1) > text_max)
    raise_at(state, place, key, "'%s' is longer than %d characters", key, static_cast<int>(text_max));
}

// Calls visit() for each entry of the list at the top of the stack, pushed above it; once for what is no list, as it
// is.
template <typename Visit>
void each_listed(lua_State* state, Visit visit) {
  const int value = lua_gettop(state);
  if (!lua_istable(state, value)) return visit();
  const auto count = static_cast<int>(lua_objlen(state, value));
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(state, value, i);
    visit();
    lua_pop(state, 1);
  }
}

void check_types(lua_State* state, int table, const ScriptPlace& place, const char* const* names) {
  for (; *names != nullptr; ++names) {
    lua_getfield(state, table, *names);
    const auto known = std::ranges::find(key_types, *names, &KeyType::key);
    const char* wanted = known == std::end(key_types) ? nullptr : known->type;
    if (!lua_isnil(state, -1) && wanted != nullptr && std::strcmp(luaL_typename(state, -1), wanted) != 0) {
      const char* given =
          to_parameter(state, -1) != nullptr ? "parameter: ask it in a function" : luaL_typename(state, -1);
      const bool quoted = lua_type(state, -1) == LUA_TSTRING && std::strcmp(wanted, "boolean") == 0;
      raise_at(state, place, *names, "'%s' must be a %s, not a %s%s", *names, wanted, given,
               quoted ? ": true has no quotes" : "");
    }
    check_text_length(state, place, *names);
    lua_pop(state, 1);
  }
}

// Whether the field holds something that counts as true.
bool flag_of(lua_State* state, int table, const char* key) {
  lua_getfield(state, table, key);
  const bool yes = lua_toboolean(state, -1) != 0;
  lua_pop(state, 1);
  return yes;
}

// controls = "legs" or controls = { "legs", "arms" }
void check_controls(lua_State* state, int table, const ScriptPlace& place) {
  lua_getfield(state, table, "controls");
  const int value = lua_gettop(state);
  const bool list = lua_istable(state, value);
  const auto count = list ? static_cast<int>(lua_objlen(state, value)) : 1;
  if (!lua_isnil(state, value) && !list && lua_type(state, value) != LUA_TSTRING)
    raise_at(state, place, "controls", "'controls' must be the name of a control set or a list of names, not a %s",
             luaL_typename(state, value));
  if (count < 1 || count > static_cast<int>(max_control_sets))
    raise_at(state, place, "controls", "'controls' is a list of 1..%d names of control sets, not of %d%s",
             static_cast<int>(max_control_sets), count, count == 0 ? ": controls = { \"legs\", \"arms\" }" : "");
  each_listed(state, [&] {
    if (list && lua_type(state, -1) != LUA_TSTRING)
      raise_at(state, place, "controls", "'controls' lists names of control sets, not a %s", luaL_typename(state, -1));
    check_text_length(state, place, "controls");
  });
  lua_pop(state, 1);
}

// to = "a" or to = { "p.x", "q.y" }, and `initial` likewise
void check_targets(lua_State* state, int table, const ScriptPlace& place, const char* key) {
  lua_getfield(state, table, key);
  const int value = lua_gettop(state);
  const bool list = lua_istable(state, value);
  if (list && (lua_objlen(state, value) == 0 || lua_objlen(state, value) > listed_max))
    raise_at(state, place, key, "'%s' lists 1 to %d states, in regions of one k.parallel", key,
             static_cast<int>(listed_max));
  each_listed(state, [&] {
    if (lua_type(state, -1) != LUA_TSTRING && (list || !lua_isnil(state, -1)))
      raise_at(state, place, key, "'%s' must be the name of a state, or a list of names, not a %s%s", key,
               list ? "list with a " : "", luaL_typename(state, -1));
    check_text_length(state, place, key);
  });
  lua_pop(state, 1);
}

void check_after(lua_State* state, int table, const ScriptPlace& place) {
  lua_getfield(state, table, "after");
  if (!lua_isnil(state, -1) && to_parameter(state, -1) == nullptr) {
    const bool good =
        lua_type(state, -1) == LUA_TNUMBER && lua_tonumber(state, -1) >= 0 && std::isfinite(lua_tonumber(state, -1));
    if (!good) raise_at(state, place, "after", "'after' must be seconds >= 0, or a parameter from k.params");
  }
  lua_pop(state, 1);
}

void check_on(lua_State* state, int table, const ScriptPlace& place) {
  lua_getfield(state, table, "on");
  const int on = lua_gettop(state);
  const bool list = lua_istable(state, on);
  if (list && (lua_objlen(state, on) == 0 || lua_objlen(state, on) > listed_max))
    raise_at(state, place, "on", "'on' lists 1 to %d events: on = { \"a\", \"b\" }", static_cast<int>(listed_max));
  each_listed(state, [&] {
    if (!list && lua_isnil(state, -1)) return;
    if (lua_type(state, -1) != LUA_TSTRING)
      raise_at(state, place, "on", "'on' must be an event's name or a list of names, not a %s%s",
               list ? "list with a " : "", luaL_typename(state, -1));
    check_text_length(state, place, "on");
    if (lua_objlen(state, -1) == 0) raise_at(state, place, "on", "'on' is the name of an event, not an empty text");
    const char* star = std::strchr(lua_tostring(state, -1), '*');
    const bool first = star == lua_tostring(state, -1);
    if (star != nullptr && (star[1] != '\0' || (!first && (star[-1] != '.' || star == lua_tostring(state, -1) + 1))))
      raise_at(state, place, lua_tostring(state, -1),
               "on = \"%s\": '*' stands for all words behind a dot, on = \"fault.*\", or alone for all events",
               lua_tostring(state, -1));
  });
  lua_pop(state, 1);
}

void check_transition(lua_State* state, int table, const ScriptPlace& place) {
  core_of(state).budget.charge(state, transition_instructions);
  const auto has = [&](const char* key) { return flag_of(state, table, key); };
  if (!has("to") && !has("action")) {
    check_keys(state, table, place, "a transition", transition_keys);  // `target` says more than a missing `to`
    lua_getfield(state, table, "on");
    raise_at(state, place, lua_tostring(state, -1),
             "a transition needs 'to': the state it leads to; or an 'action' alone, which leaves no state");
  }
  check_keys(state, table, place, "a transition", transition_keys);
  check_types(state, table, place, transition_keys);
  check_on(state, table, place);
  check_targets(state, table, place, "to");
  check_after(state, table, place);
  if (has("internal") && !has("to"))
    raise_at(state, place, "internal", "'internal' says how a transition leads into its state: it needs 'to'");
}

void check_transitions(lua_State* state, int list, const ScriptPlace& place, bool nodes_too) {
  const int count = static_cast<int>(lua_objlen(state, list));
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(state, list, i);
    const int entry = lua_gettop(state);
    if (const std::optional<NodeKind> kind = node_kind(state, entry)) {
      if (!nodes_too)
        raise_at(state, place, node_name(state, entry), "only transitions belong here, not a %s", node_word(*kind));
    } else if (lua_isfunction(state, entry)) {
      raise_at(state, place, nullptr, "%d: a k.state, k.call or other part without its { ... }?", i);
    } else if (!lua_istable(state, entry)) {
      raise_at(state, place, nullptr, "entry %d must be a state or a transition, not a %s", i,
               luaL_typename(state, entry));
    } else {
      check_transition(state, entry, place);
    }
    lua_pop(state, 1);
  }
}

// [-1 +1] The body at the top becomes a node.
void make_node(lua_State* state, NodeKind kind, const char* name, const ScriptPlace& place) {
  lua_createtable(state, 0, 5);
  lua_insert(state, -2);
  lua_setfield(state, -2, "body");
  set_field(state, "kind", static_cast<int>(kind));
  set_field(state, "name", name);
  set_field(state, "chunk", place.chunk);
  set_field(state, "line", place.line);
  set_kind(state, node_key);
}

// always = { when = ..., to = ... } would be an empty list.
void check_list(lua_State* state, int list, const ScriptPlace& place) {
  for (const char* const* key = transition_keys; *key != nullptr; ++key) {
    lua_getfield(state, list, *key);
    if (!lua_isnil(state, -1))
      raise_at(state, place, "always", "'always' is a list of transitions: always = { { %s = ... } }", *key);
    lua_pop(state, 1);
  }
}

// Upvalues: kind, name, chunk, line. Takes the body.
int finish_node(lua_State* state) {
  const auto kind = static_cast<NodeKind>(lua_tointeger(state, lua_upvalueindex(1)));
  const char* name = lua_tostring(state, lua_upvalueindex(2));
  const ScriptPlace place{lua_tostring(state, lua_upvalueindex(3)),
                          static_cast<int>(lua_tointeger(state, lua_upvalueindex(4)))};
  if (!lua_istable(state, 1)) {
    return raise_at(state, place, nullptr, "%s \"%s\" needs a table { ... }", node_word(kind), name);
  }
  lua_settop(state, 1);
  core_of(state).budget.charge(state, node_instructions);
  check_keys(state, 1, place, node_word(kind), keys_of(kind));
  check_types(state, 1, place, keys_of(kind));
  check_controls(state, 1, place);
  check_targets(state, 1, place, kind == NodeKind::history ? "to" : "initial");
  check_transitions(state, 1, place, true);
  if (kind == NodeKind::final_state && lua_objlen(state, 1) > 0)
    raise_at(state, place, nullptr, "a k.final is an end: no transition leaves it, and no state is in it");
  lua_getfield(state, 1, "always");
  if (lua_istable(state, 2)) check_list(state, 2, place);
  if (lua_istable(state, 2)) check_transitions(state, 2, place, false);
  lua_settop(state, 1);
  make_node(state, kind, name, place);
  return 1;
}

// The name at index 1 of k.state "name" and its kin.
void check_name(lua_State* state, const char* word, const ScriptPlace& place) {
  if (lua_type(state, 1) != LUA_TSTRING) raise_at(state, place, nullptr, "%s needs a name", word);
  const char* name = lua_tostring(state, 1);
  if (lua_objlen(state, 1) > name_max) {
    raise_at(state, place, nullptr, "%s: a name has at most %d characters", word, static_cast<int>(name_max));
  }
  if (!is_word(name)) {
    raise_at(state, place, name, "%s: a name is letters, digits and '_', not \"%s\"", word, name);
  }
}

// k.state "name" { ... } and its kin; upvalue: kind.
int begin_node(lua_State* state) {
  const auto kind = static_cast<NodeKind>(lua_tointeger(state, lua_upvalueindex(1)));
  const ScriptPlace place = calling_place(state);
  check_name(state, node_word(kind), place);
  if (lua_istable(state, 2)) {  // of `return k.behavior("t", { ... })` no place is left on the stack
    const std::string& main_chunk = core_of(state).owner->sources().front().chunk;
    const bool placed = place.line > 0;
    return raise_at(state, placed ? place : ScriptPlace{main_chunk.c_str(), 1}, placed ? nullptr : node_word(kind) + 2,
                    "%s \"%s\" { ... } takes its table behind the name, without a comma", node_word(kind),
                    lua_tostring(state, 1));
  }
  if (kind == NodeKind::decisions) declare_play_events(state);
  push_node_maker(state, kind, 1, place);
  return 1;
}

// k.call "name" or k.call "name" { argument = value }: a node at once, that can be called with the arguments.
int make_call(lua_State* state) {
  const ScriptPlace place = calling_place(state);
  if (lua_type(state, 1) != LUA_TSTRING) return raise_at(state, place, nullptr, "k.call needs the name of a behavior");
  lua_settop(state, 1);
  charge_text(state, static_cast<double>(lua_objlen(state, 1)));
  lua_newtable(state);
  make_node(state, NodeKind::call, lua_tostring(state, 1), place);
  return 1;
}

int take_arguments(lua_State* state) {  // (node, arguments)
  if (node_kind(state, 1) != NodeKind::call || !lua_istable(state, 2))
    return luaL_error(state, "only k.call takes arguments, in a table { ... }; is a comma missing before this table?");
  lua_settop(state, 2);
  lua_setfield(state, 1, "body");
  return 1;
}

}  // namespace

const char* node_word(NodeKind kind) noexcept { return node_words[static_cast<std::size_t>(kind)].word; }

std::optional<NodeKind> node_kind(lua_State* state, int index) {
  if (!lua_istable(state, index) || !is_kind(state, index, node_key)) return std::nullopt;
  lua_pushvalue(state, index);
  lua_getfield(state, -1, "kind");
  const auto kind = static_cast<NodeKind>(lua_tointeger(state, -1));
  lua_pop(state, 2);
  return kind;
}

const char* node_name(lua_State* state, int index) {
  lua_getfield(state, index, "name");
  const char* name = lua_tostring(state, -1);
  lua_pop(state, 1);
  return name;  // anchored by the node
}

int find_line(lua_State* state, const ScriptPlace& place, const char* text) {
  const LuaState& owner = *core_of(state).owner;
  core_of(state).budget.charge(state, owner.search_instructions(place.chunk));
  return owner.line_of(place.chunk, place.line, text);
}

std::vector<std::string> transition_key_names() {
  return {std::begin(transition_keys), std::prev(std::end(transition_keys))};
}

void check_node_name(lua_State* state, const char* word, const ScriptPlace& place) { check_name(state, word, place); }

void push_node_maker(lua_State* state, NodeKind kind, int name, const ScriptPlace& place) {
  lua_pushinteger(state, static_cast<int>(kind));
  lua_pushvalue(state, name);
  lua_pushstring(state, place.chunk);
  lua_pushinteger(state, place.line);
  lua_pushcclosure(state, finish_node, 4);
}

void open_nodes(lua_State* state) {
  const luaL_Reg functions[] = {{"__call", take_arguments}};
  open_kind(state, node_key, functions);
  constexpr NodeKind kinds[] = {NodeKind::behavior, NodeKind::decisions,   NodeKind::state,  NodeKind::parallel,
                                NodeKind::region,   NodeKind::final_state, NodeKind::history};
  for (const NodeKind kind : kinds) {
    lua_pushinteger(state, static_cast<int>(kind));
    lua_pushcclosure(state, begin_node, 1);
    lua_setfield(state, -2, node_word(kind) + 2);
  }
  lua_pushcfunction(state, make_call);
  lua_setfield(state, -2, "call");
}

namespace {

constexpr std::size_t states_max = 4000, transitions_max = 16000;  // what a chart takes is not the script's memory
constexpr int call_depth_max = 16;

ScriptPlace node_place(lua_State* state, int index) {
  lua_getfield(state, index, "chunk");
  lua_getfield(state, index, "line");
  const ScriptPlace place{lua_tostring(state, -2), static_cast<int>(lua_tointeger(state, -1))};
  lua_pop(state, 2);
  return place;
}

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
    if (value != nullptr && lua_objlen(state, -1) > text_max) luaL_error(state, "'%s' is too long", key);
    lua_pop(state, 1);
    return value != nullptr ? value : "";
  }

  void read_names(int table, const char* key, std::vector<std::string>& names) const {
    lua_getfield(state, table, key);
    each_listed(state, [&] {
      if (lua_type(state, -1) == LUA_TSTRING) names.emplace_back(lua_tostring(state, -1));
    });
    lua_pop(state, 1);
  }

  // Looks through what is there already.
  EventId intern(const char* event) const {
    core_of(state).budget.charge(state, static_cast<double>(chart.events.size()));
    return chart.intern(event);
  }

  // One transition for each of its events.
  void read_transition(int table, StateIndex source, const ScriptPlace& place) {
    lua_getfield(state, table, "on");
    const int on = lua_gettop(state);
    if (!lua_istable(state, on)) {
      add_transition(table, lua_isnil(state, on) ? "" : text(table, "on"), source, place);
    } else {
      const int count = static_cast<int>(lua_objlen(state, on));
      for (int i = 1; i <= count; ++i) {
        lua_rawgeti(state, on, i);
        add_transition(table, lua_tostring(state, -1), source, place);
        chart.transitions.back().listed = i > 1;
        lua_pop(state, 1);
      }
    }
    lua_settop(state, on - 1);
  }

  void add_transition(int table, const char* on, StateIndex source, const ScriptPlace& place) {
    if (chart.transitions.size() >= transitions_max)
      raise_at(state, place, nullptr, "more than %d transitions", static_cast<int>(transitions_max));
    Chart::Transition& made = chart.transitions.emplace_back();
    made.source = source;
    read_names(table, "to", made.target_names);
    made.line = find_line(state, place,
                          !made.target_names.empty() ? made.target_names.front().c_str()
                          : *on != '\0'              ? on
                                                     : "action");
    made.when = reference(table, "when");
    made.action = reference(table, "action");
    made.internal = flag_of(state, table, "internal");
    if (*on != '\0') made.on = intern(on);
    if (Chart::is_pattern(on)) {
      made.pattern = chart.intern_pattern(on);
      if (chart.patterns.size() > Chart::patterns_max)
        raise_at(state, place, on, "more than %d different names with '*'", static_cast<int>(Chart::patterns_max));
    }
    lua_getfield(state, table, "after");
    made.timed = !lua_isnil(state, -1);
    if (const std::size_t* number = to_parameter(state, -1)) {
      made.after_parameter = static_cast<std::int32_t>(*number);
      made.after_name = core_of(state).parameters[*number].name;
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
      if (!node_kind(state, -1)) read_transition(lua_gettop(state), source, place);
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
    read_names(body, "controls", chart.states[index].controls);
    {
      Chart::State& made = chart.states[index];
      made.enter = reference(body, "enter");
      made.exit = reference(body, "exit");
      made.during = reference(body, "during");
      made.run = reference(body, "run");
      made.result = reference(body, "result");
      read_names(body, made.kind == Chart::Kind::history ? "to" : "initial", made.initial_names);
      made.outcome_name = text(body, "outcome");
      if (made.kind == Chart::Kind::final_state) {
        made.outcome_given = !made.outcome_name.empty();
        if (made.outcome_name.empty()) made.outcome_name = "done";
        made.outcome = intern(made.outcome_name.c_str());
      }
      made.deep = flag_of(state, body, "deep");
      made.endless = flag_of(state, body, "endless");
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
      if (const auto kind = node_kind(state, -1)) read_node(lua_gettop(state), *kind, index, depth);
      lua_settop(state, body);
    }
  }

  void read_node(int node, NodeKind kind, StateIndex parent, int depth) {
    const ScriptPlace place = node_place(state, node);
    const char* name = node_name(state, node);
    if (kind == NodeKind::call) return read_call(node, name, parent, place, depth);
    if (kind == NodeKind::behavior || kind == NodeKind::decisions)
      raise_at(state, place, nullptr, "a behavior inside a behavior: k.call \"%s\" does that", name);
    constexpr Chart::Kind kinds[] = {Chart::Kind::state,  Chart::Kind::state,       Chart::Kind::parallel,
                                     Chart::Kind::region, Chart::Kind::final_state, Chart::Kind::history};
    const StateIndex index =
        add_state(name, kinds[static_cast<int>(kind)], parent, chart.states[parent].machine, place);
    lua_getfield(state, node, "body");
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
    const NodeKind wanted = chart.decides ? NodeKind::decisions : NodeKind::behavior;
    if (node_kind(state, behavior) != wanted) {
      raise_at(state, place, name, "k.call: '%s' does not return a %s%s", name, node_word(wanted),
               chart.decides ? ": decisions m:play() behaviors" : "");
    }
    lua_getfield(state, node, "body");
    const int given = lua_gettop(state);
    const std::size_t number = chart.machines.size();
    read_machine(behavior, parent, depth + 1);
    read_given(state, chart, number, given, place);
  }

  int declared_arguments(int body, const ScriptPlace& place) const {
    lua_getfield(state, body, "args");
    if (lua_isnil(state, -1)) {
      push_file_declarations(state, place.chunk);
    } else {
      push_declarations(state, lua_gettop(state), place);
    }
    const int declared = lua_isnil(state, -1) ? Chart::no_function : luaL_ref(state, LUA_REGISTRYINDEX);
    lua_settop(state, body);
    return declared;
  }

  StateIndex read_machine(int behavior, StateIndex parent, int depth) {
    const ScriptPlace place = node_place(state, behavior);
    const char* name = node_name(state, behavior);
    const auto number = static_cast<std::uint16_t>(chart.machines.size());
    chart.machines.emplace_back();
    const StateIndex index = add_state(parent == no_state ? "" : name, Chart::Kind::state, parent, number, place);
    chart.states[index].machine_root = true;
    lua_getfield(state, behavior, "body");
    const int body = lua_gettop(state);
    Chart::Machine& machine = chart.machines[number];
    machine.name = name;
    machine.root = index;
    machine.vars = reference(body, "vars");
    machine.migrate = reference(body, "migrate");
    chart.machines[number].arguments = declared_arguments(body, place);
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
  const auto states = static_cast<double>(chart.states.size());
  double names = states;
  for (const Chart::State& one : chart.states) names += static_cast<double>(one.initial_names.size());
  for (const Chart::Transition& one : chart.transitions) {  // each target is compared with the ones before it, too
    const auto count = static_cast<double>(one.target_names.size());
    names += count + count * count / 4;
  }
  core_of(state).budget.charge(state, states * names / looks_per_instruction);
  core_of(state).budget.charge(state, states * source_bytes / bytes_per_instruction);
}

}  // namespace

void read_chart(lua_State* state, int index, Chart& chart) {
  Reader reader{state, chart};
  chart.decides = node_kind(state, index) == NodeKind::decisions;
  chart.name = node_name(state, index);
  reader.read_machine(index, no_state, 0);
  charge_resolving(state, chart);
}

}  // namespace kadans
