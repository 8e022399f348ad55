// Values that only this program makes: control objects, motions, armed transactions, parameters, nodes of a chart.
// Their kind is their metatable, which is known by the address of a key. Scripts cannot read or change it.
#pragma once

#include <span>

#include <lua.hpp>

namespace kadans {

using HandleKey = char;  // a constant of the file that makes the kind: its address counts

// [-0 +0] Puts the functions into the table at the top of the stack.
void set_functions(lua_State* state, std::span<const luaL_Reg> functions);
// [-1 +0] The table at the top of the stack is the metatable of the kind from now on.
void open_kind(lua_State* state, const HandleKey& key);
// [-0 +0] Opens a kind whose metatable has these functions.
void open_kind(lua_State* state, const HandleKey& key, std::span<const luaL_Reg> functions);
// [-0 +0] Opens a kind of user data: reading a field calls read_field, whose upvalue 1 is the table of methods.
void open_kind(lua_State* state, const HandleKey& key, std::span<const luaL_Reg> methods, lua_CFunction read_field);
// [-0 +0] Gives the kind to the value at the top of the stack.
void set_kind(lua_State* state, const HandleKey& key);
// [-1 +1] Replaces the table at the top of the stack by an empty one: reading a field calls `read`, whose upvalue 1 is
// the table, writing one calls `write`.
void push_reader(lua_State* state, lua_CFunction read, lua_CFunction write);
bool is_kind(lua_State* state, int index, const HandleKey& key) noexcept;
// What is behind user data of the kind; nullptr: it is something else.
void* to_handle(lua_State* state, int index, const HandleKey& key) noexcept;
// For read_field: pushes the method that is read, or raises. `what`: "a motion".
int push_method(lua_State* state, const char* what);

}  // namespace kadans
