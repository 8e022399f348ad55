// Helper functions for the methods of a control object: m.<object>:method(...).
#pragma once

#include <cstdint>
#include <string>

#include <lua.hpp>

#include "kadans/control/catalog.h"

namespace kadans {

// The object on which the method was called; `number` is its index in the catalog. Raises.
const ObjectInfo& check_object(lua_State* state, std::uint32_t& number);
// The name without the prefix of the object's name.
const char* short_name(const ObjectInfo& object, const std::string& name) noexcept;
void check_range(lua_State* state, const char* name, const char* unit, double value, double min, double max);
// Returns nil, "queue_full" to the script.
int queue_full(lua_State* state);

// [-0 +0] Adds move, move_through, set and follow to the methods in the table at the top of the stack.
void open_motion_methods(lua_State* state);

}  // namespace kadans
