// The data that every C function of the sandbox can reach from its lua_State: it is the user data of the allocator.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include <lua.hpp>

#include "budget.h"
#include "kadans/signal/random.h"
#include "lua_heap.h"
#include "script/bindings/snapshot_tables.h"
#include "script/host/script_declarations.h"
#include "script_error.h"

namespace kadans {

class LuaState;

struct LuaCore {
  LuaHeap heap;
  const ScriptLimits& limits;
  ScriptError error{};
  Budget budget{heap, error, limits};
  RandomStream random;
  TableSlots slots{};
  std::deque<ScriptParameter> parameters{};
  std::vector<ScriptEvent> events{};  // declared in k.events
  LuaState* owner = nullptr;
  lua_State* main = nullptr;
  lua_State* running = nullptr;        // the coroutine of a `run` while it runs, else nullptr
  void* bindings = nullptr;            // of the behavior that owns the state
  int (*entry)(lua_State*) = nullptr;  // the function that LuaState::call() runs
  int handler = LUA_NOREF;             // registry: keeps the message and the stack of an error
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

// [-0 +1] Pushes an entry of the table that a registry reference stands for.
inline void push_entry(lua_State* state, int table, int at) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, table);
  lua_rawgeti(state, -1, at);
  lua_remove(state, -2);
}
inline void push_entry(lua_State* state, int table, const char* key) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, table);
  lua_pushstring(state, key);
  lua_rawget(state, -2);
  lua_remove(state, -2);
}
// [-1 +0] Gives it the value at the top of the stack.
inline void set_entry(lua_State* state, int table, int at) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, table);
  lua_insert(state, -2);
  lua_rawseti(state, -2, at);
  lua_pop(state, 1);
}

// [-0 +0] Sets a field of the table at the top of the stack.
inline void set_field(lua_State* state, const char* key, const char* text) {
  lua_pushstring(state, text);
  lua_setfield(state, -2, key);
}
inline void set_field(lua_State* state, const char* key, double number) {
  lua_pushnumber(state, number);
  lua_setfield(state, -2, key);
}

// Notes the innermost script line in `error`. When there is none (a tail call leaves no trace), it notes the line where
// the function that was called last begins. Never allocates.
void note_place(lua_State* state, ScriptError& error) noexcept;

// Counts the steps of work in C and charges the budget for them, one slice at a time. When the budget is used up, the
// work is stopped in the middle. A step is about six machine instructions; tests/script/sandbox/charge_count.cpp checks
// that.
class StepMeter {
 public:
  explicit StepMeter(lua_State* state) noexcept : state_(state) {}

  // Raises when the budget is used up.
  void spend(std::size_t steps = 1) {
    left_ -= static_cast<std::ptrdiff_t>(steps);
    if (left_ < 0) [[unlikely]]
      settle();
  }
  // Charges the steps since the last charge; to be called at the end of the work. Raises when the budget is used up.
  void settle() {
    const std::ptrdiff_t spent = slice - left_;
    left_ = slice;
    core_of(state_).budget.charge(state_, static_cast<double>(spent / steps_per_instruction));
  }

  // The steps for bytes that are copied or compared in one go.
  static constexpr std::size_t of_bytes(std::size_t bytes) noexcept { return bytes / bytes_per_step + 1; }

 private:
  static constexpr std::ptrdiff_t steps_per_instruction = 8;
  static constexpr std::ptrdiff_t slice = 4096;  // about 10 us
  static constexpr std::size_t bytes_per_step = 2;
  lua_State* state_;
  std::ptrdiff_t left_ = slice;
};

}  // namespace kadans
