// Shows a behavior that stands still: the frames of its stack, their variables, and expressions in them.
//
// The innermost frames are Lua functions; around them are the states of the chart, from the one whose function runs
// outwards. Looking changes the Lua state: tables that are shown are kept, and an expression may do anything. So it is
// for a copy of the process (fork) that never goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "script/chart/chart.h"

struct lua_State;

namespace kadans {

class Behavior;

// Where a script stands, so that steps can be told apart.
struct ScriptMoment {
  const void* owner = nullptr;  // the LuaState
  bool in_run = false;          // in the coroutine of a state's `run`
  StateIndex state = no_state;  // whose function runs
  int depth = 0;                // of Lua functions that have called one another
  bool run_under_way = false;   // of `asked`
};
// `asked`: a state whose `run` is asked for. Leaves the state as it is.
ScriptMoment script_moment(lua_State* state, StateIndex asked) noexcept;

bool plays_in(Behavior& behavior, lua_State* state) noexcept;

struct ShownFrame {
  std::string name, chunk;
  int line = 0;
  bool of_chart = false;
};
struct ShownValue {
  std::string name, text, type;
  std::uint32_t fields = 0;  // a number for fields(); 0: it has none
};

class Inspection {
 public:
  // `running`: the Lua state in which it stands, a coroutine or the behavior's own; nullptr: it is between two ticks.
  Inspection(Behavior& behavior, lua_State* running);

  const std::vector<ShownFrame>& frames() const noexcept { return frames_; }
  // The variables of a frame, in groups: locals, upvalues, vars, args, params, s. None when there is no such frame.
  std::vector<ShownValue> scopes(std::size_t frame);
  // What is in a group or in a table. None when there is no such number.
  std::vector<ShownValue> fields(std::uint32_t number);
  // Lua, an expression or a statement, with the names of the frame; of the innermost one when there is no such frame.
  // False: the text says what is wrong.
  [[nodiscard]] bool evaluate(std::size_t frame, const std::string& lua, ShownValue& value);

 private:
  struct Spot {                   // of a frame
    lua_State* thread = nullptr;  // nullptr: of the chart
    int level = 0;
    StateIndex state = 0;
  };

  void add_frames(lua_State* thread, bool outermost);
  void add_states(StateIndex from);
  std::string function_name(lua_State* thread, int level, bool outermost) const;
  // Lists what is in a group or in a table.
  using Lister = std::function<void(std::vector<ShownValue>& to)>;
  std::uint32_t add(Lister lister);
  bool push_function(const Spot& spot);
  const char* push_local(const Spot& spot, int number);
  bool push_machine_field(StateIndex state, const char* field);
  ShownValue shown(const std::string& name);
  std::string text_of(int index, bool inside);
  void list_locals(const Spot& spot, std::vector<ShownValue>& to);
  void list_upvalues(const Spot& spot, std::vector<ShownValue>& to);
  template <typename Visit>
  void each_param(const Spot& spot, Visit visit);
  void list_params(const Spot& spot, std::vector<ShownValue>& to);
  void list_table(int reference, std::vector<ShownValue>& to);
  void list_scopes(std::size_t frame, std::vector<ShownValue>& to);
  void push_names(const Spot& spot);
  bool run(const Spot& spot, const std::string& lua, ShownValue& value);
  template <typename Work>
  bool guarded(Work work);

  Behavior& behavior_;
  lua_State* lua_;  // of its own, in which everything here is done
  std::vector<ShownFrame> frames_;
  std::vector<Spot> spots_;
  std::vector<Lister> groups_;
};

}  // namespace kadans
