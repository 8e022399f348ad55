// Limits what a script may use in one call: instructions, time and memory.
//
// A hook runs every thousand instructions and raises when a limit is passed. A script may catch the error with pcall.
// So the hook also sets itself to raise again at every following instruction, and a loop around a pcall ends, too.
// Library functions that work long in C count their own steps and are charged for them (StepMeter), so they are
// stopped in the middle.
//
// Some single instructions of the interpreter work long and cannot be counted: to compare or join strings of 64 kB, or
// to read one as a number, takes up to 0.1 ms. So on the wall clock there is also a limit of time, and the hook runs
// every fifty instructions. Time in which the machine runs other threads is not counted. On virtual time, where a run
// repeats bit for bit, only instructions and memory are limited.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lua_heap.h"
#include "script_error.h"

struct lua_State;
struct lua_Debug;

namespace kadans {

class BehaviorInputs;

// What a debugger hears of scripts while they run. Nobody listens in a run that is not debugged: then no hook for lines
// is set.
class LineWatch {
 public:
  virtual ~LineWatch() = default;
  // Before the first instruction of a line; of `state`, which may be a coroutine. What is called must leave the state
  // as it is.
  virtual void line(lua_State* state, const char* chunk, int line) noexcept = 0;
  // A script raised an error that it does not catch. Its stack still stands.
  virtual void raised(lua_State* state, const char* message) noexcept = 0;
};

// To be called when the program shall end; any thread, also a signal handler. A running script is stopped after 0.2 s,
// in which most scripts end by themselves. Scripts that are called later are stopped as well, until
// interrupt_scripts(false).
void interrupt_scripts(bool yes = true) noexcept;

// What one playing behavior may use. Instructions are those of the Lua interpreter, counted in steps of a thousand; a
// library call is charged in proportion to its work. Time is that of the wall clock, without the time in which the
// machine ran other threads.
struct ScriptLimits {
  std::uint64_t tick_instructions = 200'000;
  std::uint64_t load_instructions = 5'000'000;
  std::uint64_t reload_instructions = 1'000'000;  // fewer, because all behaviors stand still meanwhile
  std::int64_t tick_wall_ns = 0;                  // 0: no limit; so on a virtual clock, where a run repeats bit for bit
  std::int64_t load_wall_ns = 0;                  // the same for loading or reloading a file
  std::size_t memory_bytes = std::size_t{4} << 20;
  std::size_t block_bytes = std::size_t{576} << 10;  // of one string or one table's array; the deepest stack fits
  // Of a run that is recorded or repeated: whoever does that then says whether time is over, and what a parameter is.
  BehaviorInputs* const* inputs = nullptr;
  LineWatch* const* watch = nullptr;  // of a run that is debugged: hears of lines and errors

  BehaviorInputs* inputs_now() const noexcept { return inputs != nullptr ? *inputs : nullptr; }
  LineWatch* watch_now() const noexcept { return watch != nullptr ? *watch : nullptr; }
};

class Budget {
 public:
  // The references must outlive it.
  Budget(LuaHeap& heap, ScriptError& error, const ScriptLimits& limits) noexcept
      : heap_(heap), error_(error), limits_(limits) {}
  LineWatch* watch() const noexcept { return limits_.watch_now(); }

  // Begins a new count. wall_ns 0: no limit of time.
  void begin(lua_State* state, std::uint64_t instructions, std::int64_t wall_ns) noexcept;

  // Counts work done in C as instructions. Raises when the budget does not allow it.
  void charge(lua_State* state, double instructions);
  // Charges for C code that goes through a function or the stack, whose size is unknown; the largest block of memory is
  // an upper bound.
  void charge_scan(lua_State* state);

  // True when a limit was passed since begin(). The script is stopped even if it caught the error.
  bool breached() const noexcept { return error_.breach != ScriptBreach::none; }
  std::uint64_t left() const noexcept { return spent_ < limit_ ? limit_ - spent_ : 0; }
  std::uint64_t spent() const noexcept { return spent_; }

  // Raises the breach again, if there is one. For functions that catch errors.
  void raise_again(lua_State* state);
  // To be called inside an allocation that passed the limit: stops the script at its next instruction. When the block
  // was not `granted`, Lua raises at once, so the place is noted now.
  void memory_ran_out(lua_State* state, bool granted) noexcept;

 private:
  static void hook(lua_State* state, lua_Debug* activation);
  void look(lua_State* state);
  bool out_of_time() noexcept;
  bool time_is_over() noexcept;
  bool interrupted() noexcept;
  void breach(lua_State* state, ScriptBreach what) noexcept;
  void describe(ScriptBreach what) noexcept;

  LuaHeap& heap_;
  ScriptError& error_;
  const ScriptLimits& limits_;
  std::uint64_t limit_ = 0, spent_ = 0;
  std::uint64_t charged_ = 0;  // since the last look at the clock
  int interval_ = 1;           // instructions from hook to hook
  std::int64_t wall_ns_ = 0;
  std::int64_t look_ns_ = 0;         // on the wall clock: when to look at the thread's clock
  std::int64_t thread_end_ns_ = 0;   // on the thread's clock; 0: not looked at yet
  std::int64_t interrupted_ns_ = 0;  // on the wall clock: when the interruption was first seen; 0: not yet
};

}  // namespace kadans
