// How the runner calls into Lua: functions of states, and the coroutines of `run`.
#include <lua.hpp>

#include "chart_runner.h"
#include "script/bindings/bindings.h"
#include "script/lua/lua_core.h"
#include "script/motion/motion.h"

namespace kadans {

// m.time_s is the time in the state whose function is called.
void ChartRunner::set_time(lua_State* state, StateIndex index) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].content);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.time_key);
  lua_pushnumber(state, state_time_s(index));
  lua_rawset(state, -3);
  lua_pop(state, 1);
}

void ChartRunner::call(lua_State* state, int function, StateIndex index) {
  set_time(state, index);
  core_of(state).called = function;
  lua_rawgeti(state, LUA_REGISTRYINDEX, function);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].handle);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.snapshot);
  lua_call(state, 2, 0);
}

void ChartRunner::start_run(lua_State* state, StateIndex index) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.threads);
  lua_State* thread = lua_newthread(state);
  lua_rawseti(state, -2, index + 1);
  lua_pop(state, 1);
  lua_rawgeti(state, LUA_REGISTRYINDEX, chart_.states[index].run);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.machines[chart_.states[index].machine].handle);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.snapshot);
  lua_xmove(state, thread, 3);
  StateRun& run = run_[index];
  run.thread = thread;
  run.thread_started = false;
  run.motion = nullptr;
  run.wake_ns = now_ns_;
}

void ChartRunner::cancel_run(lua_State* state, StateIndex index) {
  StateRun& run = run_[index];
  if (run.thread == nullptr) return;
  run.thread = nullptr;
  run.motion = nullptr;
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.threads);
  lua_pushnil(state);
  lua_rawseti(state, -2, index + 1);
  lua_pop(state, 1);
}

// Whether what the coroutine waits for is over; pushes what its wait() returns.
bool ChartRunner::ready(lua_State* state, StateRun& run, lua_State* thread, int& arguments) const noexcept {
  if (!run.thread_started) return arguments = 2, true;
  if (run.motion != nullptr) {
    const Bindings& bindings = bindings_of(state);
    observe(*run.motion, *bindings.snapshot, now_ns_);
    if (!run.motion->over()) return false;
    const char* why = failure(*run.motion);
    lua_settop(thread, 0);
    const bool refused = run.motion->state == MotionState::refused;
    arguments = why == nullptr ? 1 : refused ? 3 : 2;
    if (why == nullptr) return lua_pushboolean(thread, 1), true;
    lua_pushnil(thread);
    lua_pushstring(thread, why);
    if (refused) push_reason(thread, *run.motion);
    return true;
  }
  if (now_ns_ < run.wake_ns) return false;
  lua_settop(thread, 0);
  return arguments = 0, true;
}

void ChartRunner::resume_run(lua_State* state, StateIndex index) {
  StateRun& run = run_[index];
  lua_State* thread = run.thread;
  int arguments = 0;
  if (!ready(state, run, thread, arguments)) return;
  set_time(state, index);
  LuaCore& core = core_of(state);
  run.thread_started = true;
  core.called = chart_.states[index].run;
  wait_motion_ = nullptr;
  wait_ns_ = now_ns_;
  core.running = thread;
  const int status = lua_resume(thread, arguments);
  core.running = nullptr;
  if (status == LUA_YIELD) {
    run.motion = wait_motion_;
    run.wake_ns = wait_ns_;
    return;
  }
  if (status != 0) {
    core.budget.raise_again(state);
    const bool text = lua_type(thread, -1) == LUA_TSTRING;
    core.error.set_message(text ? lua_tostring(thread, -1) : "the script raised a value that is not a string");
    if (core.error.line == 0) note_place(thread, core.error);
    luaL_traceback(state, thread, nullptr, 0);
    core.error.set_traceback(lua_tostring(state, -1));
    lua_xmove(thread, state, 1);
    lua_error(state);
  }
  run.run_done = true;
  cancel_run(state, index);
}

}  // namespace kadans
