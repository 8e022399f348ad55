// What a debugger hears of scripts while they run. Nobody listens in a run that is not debugged: then no hook for lines
// is set.
#pragma once

struct lua_State;

namespace kadans {

class LineWatch {
 public:
  virtual ~LineWatch() = default;
  // Before the first instruction of a line; of `state`, which may be a coroutine. What is called must leave the state
  // as it is.
  virtual void line(lua_State* state, const char* chunk, int line) noexcept = 0;
  // A script raised an error that it does not catch. Its stack still stands.
  virtual void raised(lua_State* state, const char* message) noexcept = 0;
};

}  // namespace kadans
