// Writes the vars of a behavior as bytes and reads them back, for another process that continues where this one ended.
#pragma once

#include <string>

#include <lua.hpp>

#include "kadans/control/catalog.h"
#include "signal/byte_order.h"

namespace kadans {

// [-0 +0] Appends the value at `index` (> 0): plain data and handles of motions. False: it contains something else, and
// `why` says what; then the stack may hold more than before. Never raises.
bool put_value(lua_State* state, int index, ByteWriter& bytes, std::string& why, int depth = 0);

// [-0 +1] Pushes the next value of the bytes. Raises when there is none.
void push_value(lua_State* state, ByteReader& bytes, const Catalog& catalog, int depth = 0);

}  // namespace kadans
