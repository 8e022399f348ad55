// What a behavior remembers, as bytes and back: for another process that goes on where this one ended.
#pragma once

#include <string>

#include <lua.hpp>

#include "kadans/control/catalog.h"
#include "kadans/signal/byte_order.h"

namespace kadans {

// [-0 +0] Appends the value at `index` (> 0): plain data and the handles of motions. False: something else is in it,
// `why` says what. Raises nothing; the stack may hold more than before when it failed.
bool put_value(lua_State* state, int index, ByteWriter& bytes, std::string& why, int depth = 0);

// [-0 +1] The value at the front of the bytes. Raises when there is none.
void push_value(lua_State* state, ByteReader& bytes, const Catalog& catalog, int depth = 0);

}  // namespace kadans
