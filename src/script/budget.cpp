#include "kadans/script/budget.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>

#include "lua_core.h"
#include "tick_code.h"

namespace kadans {
namespace {

std::int64_t wall_now_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

const char breach_marker = 0;

bool note_active_line(lua_State* state, ScriptError& error) noexcept {
  lua_Debug activation;
  for (int level = 0; lua_getstack(state, level, &activation) != 0; ++level) {
    if (lua_getinfo(state, "Sl", &activation) == 0 || activation.currentline <= 0) continue;
    if (activation.source[0] != '@') continue;
    error.set_place(activation.source + 1, activation.currentline);
    return true;
  }
  return false;
}

}  // namespace

void note_place(lua_State* state, ScriptError& error) noexcept {
  const LuaCore& core = core_of(state);
  if (note_active_line(state, error) || (core.main != state && note_active_line(core.main, error))) return;
  if (core.called == LUA_NOREF) return;
  lua_Debug function;
  lua_rawgeti(state, LUA_REGISTRYINDEX, core.called);
  if (lua_getinfo(state, ">S", &function) != 0 && function.source[0] == '@') {
    error.set_place(function.source + 1, function.linedefined);
  }
}

KADANS_TICK_CODE void Budget::begin(lua_State* state, std::uint64_t instructions, std::int64_t wall_ns) noexcept {
  limit_ = instructions;
  spent_ = 0;
  wall_ns_ = wall_ns;
  wall_end_ns_ = wall_ns > 0 ? wall_now_ns() + wall_ns : 0;
  error_.set = false;
  error_.line = 0;
  error_.breach = ScriptBreach::none;
  heap_.forgive();
  lua_sethook(state, hook, LUA_MASKCOUNT, interval);
}

KADANS_TICK_CODE void Budget::hook(lua_State* state, lua_Debug* /*activation*/) { core_of(state).budget.look(state); }

KADANS_TICK_CODE void Budget::look(lua_State* state) {
  if (!breached()) {
    spent_ += interval;
    if (heap_.exceeded()) {
      breach(state, ScriptBreach::memory);
    } else if (spent_ >= limit_) {
      breach(state, ScriptBreach::instructions);
    } else if (wall_ns_ > 0 && wall_now_ns() > wall_end_ns_) {
      breach(state, ScriptBreach::wall_time);
    } else {
      return;
    }
  }
  raise_again(state);
}

void Budget::charge(lua_State* state, double instructions) {
  spent_ += static_cast<std::uint64_t>(std::min(instructions, 1e15));
  if (!breached() && spent_ >= limit_) breach(state, ScriptBreach::instructions);
  raise_again(state);
}

void Budget::raise_again(lua_State* state) {
  if (!breached()) return;
  lua_sethook(state, hook, LUA_MASKCOUNT, 1);
  lua_pushlightuserdata(state, const_cast<char*>(&breach_marker));  // a value that needs no memory
  lua_error(state);
}

void Budget::memory_ran_out(lua_State* state, bool granted) noexcept {
  if (breached()) return;
  if (!granted) breach(state, ScriptBreach::memory);
  lua_sethook(state, hook, LUA_MASKCOUNT, 1);
}

void Budget::breach(lua_State* state, ScriptBreach what) noexcept {
  error_.clear();
  note_place(state, error_);
  error_.breach = what;
  error_.set = true;
  auto& text = error_.message;
  if (what == ScriptBreach::memory) {
    std::snprintf(text.data(), text.size(), "out of memory: more than %.1f MB in use, or one string or table too large",
                  static_cast<double>(heap_.limit_bytes()) / (1 << 20));
  } else if (what == ScriptBreach::instructions) {
    std::snprintf(text.data(), text.size(), "instruction budget exceeded: more than %llu in one tick",
                  static_cast<unsigned long long>(limit_));
  } else {
    std::snprintf(text.data(), text.size(), "time budget exceeded: more than %.3f ms in one tick",
                  static_cast<double>(wall_ns_) * 1e-6);
  }
  lua_Debug activation;
  std::size_t used = 0;
  for (int level = 0; level < 12 && lua_getstack(state, level, &activation) != 0; ++level) {
    if (lua_getinfo(state, "Sl", &activation) == 0 || activation.source[0] != '@') continue;
    const int written = std::snprintf(error_.traceback.data() + used, error_.traceback.size() - used, "%s\t%s:%d",
                                      used == 0 ? "" : "\n", activation.source + 1, activation.currentline);
    used = std::min(used + static_cast<std::size_t>(std::max(written, 0)), error_.traceback.size() - 1);
  }
}

}  // namespace kadans
