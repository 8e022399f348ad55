// The author's tables, and how a Chart is made from them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <lua.hpp>

#include "chart.h"
#include "script/lua/lua_state.h"
#include "script/lua/script_error.h"

namespace kadans {

// The nodes that the constructors of the `kadans` module make from an author's tables. A node is a table {kind, name,
// chunk, line, body} with a metatable of its own, which distinguishes it from any other table.
enum class NodeKind : int { behavior, state, parallel, region, final_state, history, call, decisions };
const char* node_word(NodeKind kind) noexcept;  // "k.state"

// The kind of the node at `index`; nullopt: it is none.
std::optional<NodeKind> node_kind(lua_State* state, int index);
const char* node_name(lua_State* state, int index);
// [-0 +1] Pushes what makes a node of a body: the name is at `name`, and mistakes are told at `place`.
void push_node_maker(lua_State* state, NodeKind kind, int name, const ScriptPlace& place);
// [-0 +0] Raises unless the value at index 1 is a good name of a node.
void check_node_name(lua_State* state, const char* word, const ScriptPlace& place);

// [-1 +1] Adds behavior, state, parallel, region, final, history and call to the module's table at the top of the
// stack.
void open_nodes(lua_State* state);

// [-1 +1] Adds params to the module's table at the top of the stack.
void open_parameters(lua_State* state);
// Declares the events by which a k.decisions hears of what it plays. [-0 +0]
void declare_play_events(lua_State* state);
// [-1 +1] Adds events, flag and text to the module's table at the top of the stack.
void open_events(lua_State* state);
// The index in LuaCore::parameters of the parameter at `index`; nullptr: it is none.
const std::size_t* to_parameter(lua_State* state, int index);

// The line of the file on which this text stands first from the place on, charged for the search. Raises.
int find_line(lua_State* state, const ScriptPlace& place, const char* text);

std::vector<std::string> transition_key_names();

// Reads the behavior or the decisions at `index` of the stack and all that it calls into `chart`. Functions and tables
// get registry references. Raises on anything that cannot be read; wrong names are found later by Chart::resolve().
void read_chart(lua_State* state, int index, Chart& chart);

// Finds the source line of each transition of a chart. The tables from which the chart was read do not know the lines,
// so the source is searched. A transition that is not written as { ... to = "name" ... } in the braces of its state
// keeps the line that it has.
void find_transition_lines(const std::vector<LuaState::Source>& sources, Chart& chart);

}  // namespace kadans
