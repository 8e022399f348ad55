// What a script may do in one go: so many instructions, so much time, so much memory.
//
// A hook runs every thousand instructions. When a limit is passed it raises; since a script may catch that with pcall,
// it also re-arms itself to raise again at every single instruction that follows, so that no loop around a pcall
// survives. Functions of the library that work long in C count their own steps and are charged for them (step_meter.h),
// so they end in the middle.
//
// Some instructions of the interpreter itself work long and cannot be counted: to compare or join strings of 64 kB, to
// read one as a number, takes up to 0.1 ms. So where time is real a second limit counts, on the wall clock: the hook
// then runs every fifty instructions. Time in which the machine runs something else in the thread's place is not
// counted. On virtual time, where a run repeats bit for bit, only instructions and memory are limited.
#pragma once

#include <cstdint>

#include "kadans/script/lua_heap.h"
#include "kadans/script/script_error.h"

struct lua_State;
struct lua_Debug;

namespace kadans {

// From anywhere, a signal handler too: somebody wants the program to end, so a script that is running is stopped, after
// a moment in which most end by themselves. So is each that is called later, until `no`.
void interrupt_scripts(bool yes = true) noexcept;

class Budget {
 public:
  Budget(LuaHeap& heap, ScriptError& error) noexcept : heap_(heap), error_(error) {}

  // Begins a new count. wall_ns 0: no limit on time.
  void begin(lua_State* state, std::uint64_t instructions, std::int64_t wall_ns) noexcept;

  // Counts work done in C as instructions. Raises when the budget does not allow it.
  void charge(lua_State* state, double instructions);
  // Charges for C code that goes through a function or the stack, of which nobody can say how large it is: as large as
  // the largest block of memory at most.
  void charge_scan(lua_State* state);

  // Whether a limit was passed since begin(): whatever the script caught, it is stopped.
  bool breached() const noexcept { return error_.breach != ScriptBreach::none; }
  std::uint64_t left() const noexcept { return spent_ < limit_ ? limit_ - spent_ : 0; }
  std::uint64_t limit() const noexcept { return limit_; }
  std::uint64_t spent() const noexcept { return spent_; }

  // Raises the breach again, if there is one: for whatever catches errors.
  void raise_again(lua_State* state);
  // From inside an allocation that passed the limit: stops the script at its next instruction. When the block was not
  // `granted`, Lua raises at once, so the place is noted now.
  void memory_ran_out(lua_State* state, bool granted) noexcept;

 private:
  static void hook(lua_State* state, lua_Debug* activation);
  void look(lua_State* state);
  bool out_of_time() noexcept;
  bool interrupted() noexcept;
  void breach(lua_State* state, ScriptBreach what) noexcept;
  void describe(ScriptBreach what) noexcept;

  LuaHeap& heap_;
  ScriptError& error_;
  std::uint64_t limit_ = 0, spent_ = 0;
  std::uint64_t charged_ = 0;  // since the last look at the clock
  int interval_ = 1;           // instructions from hook to hook
  std::int64_t wall_ns_ = 0;
  std::int64_t look_ns_ = 0;         // on the wall clock: when to look at the thread's
  std::int64_t thread_end_ns_ = 0;   // on the thread's clock; 0: not looked at yet
  std::int64_t interrupted_ns_ = 0;  // on the wall clock: when the script was seen to go on; 0: not yet
};

}  // namespace kadans
