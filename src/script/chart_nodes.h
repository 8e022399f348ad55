// What the constructors of the `kadans` module make of an author's tables: nodes, each a table {kind, name, chunk,
// line, body} with a metatable of its own, so that a node is told from any other table.
#pragma once

#include <cstddef>

#include <lua.hpp>

#include "place.h"

namespace kadans {

enum class NodeKind : int { behavior, state, parallel, region, final_state, history, call };
const char* node_word(NodeKind kind) noexcept;  // "k.state"

// Whether the value at `index` is a node; its kind then.
bool is_node(lua_State* state, int index, NodeKind* kind);
// Of the node at `index`.
const char* node_name(lua_State* state, int index);
Place node_place(lua_State* state, int index);
void push_node_body(lua_State* state, int index);  // [-0 +1]

// [-1 +1] Adds behavior, state, parallel, region, final, history and call to the module's table at the top.
void open_nodes(lua_State* state);

// k.params: [-1 +1] adds it to the module's table at the top.
void open_parameters(lua_State* state);
// Whether the value at `index` is a parameter; its number in LuaCore::parameters then.
bool is_parameter(lua_State* state, int index, std::size_t* number);

}  // namespace kadans
