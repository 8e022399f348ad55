// Results: what the end of a state says beside its outcome, k.final "done" { result = function(m, s) ... end }. The
// function runs when the final state is entered, and what it returns is copied and bounded as an event's data is. The
// end's event has it as s.event.data.result; that of a k.parallel as s.event.data.results.REGION.
#include <lua.hpp>

#include "chart_runner.h"
#include "script/lua/lua_core.h"

namespace kadans {

// False: the function raised, and the error is going to be an event.
bool ChartRunner::make_result(lua_State* state, StateIndex index) {
  const int function = chart_.states[index].result;
  if (function == Chart::no_function) return true;
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables_.make_result);
  push_call(state, function, index);
  if (!call_recoverably(state, index, 3, 1)) return false;
  set_entry(state, tables_.results, index + 1);
  return true;
}

// The final state with which a state ended; no_state: it has not ended so.
StateIndex ChartRunner::final_in(StateIndex index) const noexcept {
  for (auto child = static_cast<StateIndex>(index + 1); child < chart_.states[index].end;
       child = chart_.states[child].end) {
    if (!run_[child].active) continue;
    if (chart_.states[child].kind == Chart::Kind::final_state) return child;
    if (chart_.states[child].machine_root) return final_in(child);
  }
  return no_state;
}

// [-0 +1 when true]
bool ChartRunner::push_result_of(lua_State* state, StateIndex ended) const {
  if (ended == no_state || chart_.states[ended].result == Chart::no_function) return false;
  push_entry(state, tables_.results, ended + 1);
  return true;
}

bool ChartRunner::push_result(lua_State* state) const { return push_result_of(state, finished_by_); }

}  // namespace kadans
