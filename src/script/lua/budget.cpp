#include "budget.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>

#include "engine/behavior_inputs.h"
#include "lua_core.h"
#include "lua_state.h"
#include "signal/monotonic_clock.h"

namespace kadans {
namespace {

constexpr int interval = 1000, timed_interval = 50;  // instructions between two looks
constexpr std::int64_t interrupted_grace_ns = 200'000'000;
constexpr double scanned_bytes_per_instruction = 32;

std::atomic<bool> interruption{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler sets it");

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
  if (core.called == LUA_NOREF) {
    const auto& sources = core.owner->sources();
    if (!sources.empty()) error.set_place(sources.front().chunk.c_str(), 1);
    return;
  }
  lua_Debug function;
  lua_rawgeti(state, LUA_REGISTRYINDEX, core.called);
  if (lua_getinfo(state, ">S", &function) != 0 && function.source[0] == '@') {
    error.set_place(function.source + 1, function.linedefined);
  }
}

void interrupt_scripts(bool yes) noexcept { interruption.store(yes, std::memory_order_relaxed); }

void Budget::begin(lua_State* state, std::uint64_t instructions, std::int64_t wall_ns) noexcept {
  limit_ = instructions;
  spent_ = 0;
  charged_ = 0;
  interval_ = wall_ns > 0 ? timed_interval : interval;
  wall_ns_ = wall_ns;
  look_ns_ = wall_ns > 0 ? monotonic_ns() + wall_ns / 4 : 0;
  thread_end_ns_ = 0;
  interrupted_ns_ = 0;
  error_.set = false;
  error_.line = 0;
  error_.breach = ScriptBreach::none;
  heap_.forgive();
  lua_sethook(state, hook, watch() != nullptr ? LUA_MASKCOUNT | LUA_MASKLINE : LUA_MASKCOUNT, interval_);
}

void Budget::hook(lua_State* state, lua_Debug* activation) {
  Budget& budget = core_of(state).budget;
  if (activation->event == LUA_HOOKLINE) {
    LineWatch* const watch = budget.watch();
    if (watch != nullptr && lua_getinfo(state, "Sl", activation) != 0 && activation->source[0] == '@')
      watch->line(state, activation->source + 1, activation->currentline);
    return;
  }
  if (!budget.breached()) budget.spent_ += static_cast<std::uint64_t>(budget.interval_);
  budget.look(state);
}

void Budget::look(lua_State* state) {
  charged_ = 0;
  if (!breached()) {
    if (heap_.exceeded()) {
      breach(state, ScriptBreach::memory);
    } else if (spent_ >= limit_) {
      breach(state, ScriptBreach::instructions);
    } else if (wall_ns_ > 0 && time_is_over()) {
      breach(state, ScriptBreach::wall_time);
    } else if (interruption.load(std::memory_order_relaxed) && interrupted()) {
      breach(state, ScriptBreach::interrupted);
    } else {
      return;
    }
  }
  raise_again(state);
}

// The thread's clock costs a system call, so it is looked at only when a quarter of the time has passed on the wall
// clock, and then again each time the script could have used up what is left.
bool Budget::out_of_time() noexcept {
  const std::int64_t now_ns = monotonic_ns();
  if (now_ns < look_ns_) return false;
  const std::int64_t thread_ns = thread_cpu_ns();
  if (thread_end_ns_ == 0) thread_end_ns_ = thread_ns + wall_ns_ - wall_ns_ / 4;
  look_ns_ = now_ns + (thread_end_ns_ - thread_ns);
  return thread_ns >= thread_end_ns_;
}

bool Budget::time_is_over() noexcept {
  BehaviorInputs* const inputs = limits_.inputs_now();
  if (inputs == nullptr) return out_of_time();
  const auto over = [](void* self) noexcept { return static_cast<Budget*>(self)->out_of_time(); };
  return inputs->time_is_over(over, this);
}

bool Budget::interrupted() noexcept {
  const std::int64_t now_ns = monotonic_ns();
  if (interrupted_ns_ == 0) interrupted_ns_ = now_ns;
  return now_ns - interrupted_ns_ >= interrupted_grace_ns;
}

void Budget::charge(lua_State* state, double instructions) {
  const auto count = static_cast<std::uint64_t>(instructions > 0 ? std::min(instructions, 1e15) : 0);
  spent_ += count;
  charged_ += count;
  if (breached() || spent_ >= limit_ || charged_ >= static_cast<std::uint64_t>(interval_)) look(state);
}

void Budget::charge_scan(lua_State* state) {
  charge(state, static_cast<double>(heap_.largest_block_bytes()) / scanned_bytes_per_instruction);
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
  describe(what);
  lua_Debug activation;
  std::size_t used = 0;
  for (int level = 0; level < 12 && lua_getstack(state, level, &activation) != 0; ++level) {
    if (lua_getinfo(state, "Sl", &activation) == 0 || activation.source[0] != '@') continue;
    const int written = std::snprintf(error_.traceback.data() + used, error_.traceback.size() - used, "%s\t%s:%d",
                                      used == 0 ? "" : "\n", activation.source + 1, activation.currentline);
    used = std::min(used + static_cast<std::size_t>(std::max(written, 0)), error_.traceback.size() - 1);
  }
}

void Budget::describe(ScriptBreach what) noexcept {
  auto& text = error_.message;
  const double limit_MB = static_cast<double>(heap_.limit_bytes()) / (1 << 20);
  switch (what) {
    case ScriptBreach::memory:
      std::snprintf(
          text.data(), text.size(),
          "out of memory: more than %.1f MB in use, one string or table too large, or tables made anew too often",
          limit_MB);
      return;
    case ScriptBreach::instructions:
      std::snprintf(
          text.data(), text.size(),
          "instruction budget exceeded: more than %llu in one tick; a loop that waits for something needs m:wait(0.01)",
          static_cast<unsigned long long>(limit_));
      return;
    case ScriptBreach::wall_time:
      std::snprintf(text.data(), text.size(), "time budget exceeded: more than %.3f ms of wall-clock time in one tick",
                    static_cast<double>(wall_ns_) * 1e-6);
      return;
    case ScriptBreach::interrupted:
      std::snprintf(text.data(), text.size(), "interrupted: the program was told to end");
      return;
    case ScriptBreach::none:
      return;
  }
}

}  // namespace kadans
