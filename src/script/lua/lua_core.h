// The data that every C function of the sandbox can reach from its lua_State: it is the user data of the allocator.
#pragma once

#include <deque>

#include <lua.hpp>

#include "budget.h"
#include "kadans/signal/random.h"
#include "lua_heap.h"
#include "script/bindings/snapshot_tables.h"
#include "script/host/script_parameter.h"
#include "script_error.h"

namespace kadans {

class LuaState;

struct LuaCore {
  LuaHeap heap;
  ScriptError error{};
  Budget budget{heap, error};
  RandomStream random;
  TableSlots slots{};
  std::deque<ScriptParameter> parameters{};
  LuaState* owner = nullptr;
  lua_State* main = nullptr;
  lua_State* running = nullptr;        // the coroutine of a `run` while it runs, else nullptr
  void* bindings = nullptr;            // of the behavior that owns the state
  int (*entry)(lua_State*) = nullptr;  // the function that LuaState::call() runs
  int called = LUA_NOREF;              // registry: the chart function that was called last
  bool loading = true;
  int depth = 0;       // nesting depth of library functions that call back
  int coroutines = 0;  // nesting depth of coroutines that resume one another
};

inline LuaCore& core_of(lua_State* state) noexcept {
  void* core = nullptr;
  lua_getallocf(state, &core);
  return *static_cast<LuaCore*>(core);
}

// The CPU time of this thread, without the time of other threads. It asks the kernel, which costs about 0.7 us.
std::int64_t thread_now_ns() noexcept;

// Notes the innermost script line in `error`. When there is none (a tail call leaves no trace), it notes the line where
// the function that was called last begins. Never allocates.
void note_place(lua_State* state, ScriptError& error) noexcept;

}  // namespace kadans
