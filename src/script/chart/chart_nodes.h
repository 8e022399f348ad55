// The nodes that the constructors of the `kadans` module make from an author's tables. A node is a table {kind, name,
// chunk, line, body} with a metatable of its own, which distinguishes it from any other table.
#pragma once

#include <cstddef>

#include <lua.hpp>

#include "script/lua/script_error.h"

namespace kadans {

enum class NodeKind : int { behavior, state, parallel, region, final_state, history, call };
const char* node_word(NodeKind kind) noexcept;  // "k.state"

// True when the value at `index` is a node; then `kind` is set.
bool is_node(lua_State* state, int index, NodeKind* kind);
// The name, the place and the body of the node at `index`.
const char* node_name(lua_State* state, int index);
ScriptPlace node_place(lua_State* state, int index);
void push_node_body(lua_State* state, int index);  // [-0 +1]

// [-1 +1] Adds behavior, state, parallel, region, final, history and call to the module's table at the top of the
// stack.
void open_nodes(lua_State* state);

// [-1 +1] Adds params to the module's table at the top of the stack.
void open_parameters(lua_State* state);
// True when the value at `index` is a parameter; then `number` is its index in LuaCore::parameters.
bool is_parameter(lua_State* state, int index, std::size_t* number);

}  // namespace kadans
