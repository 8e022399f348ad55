// What a behavior is made of; behavior_loading.cpp puts it together, behavior.cpp runs it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bindings.h"
#include "kadans/script/behavior.h"
#include "kadans/script/chart_runner.h"
#include "kadans/script/lua_state.h"
#include "log_bound.h"
#include "snapshot_tables.h"

namespace kadans {

struct Behavior::Parts final : ScriptVoice, TransitionSink {
  Parts(const Settings& wanted, const Catalog& offered, BehaviorLog& to);
  ~Parts() override = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void say(const char* text) noexcept override;
  void say_with(BehaviorLog::Severity severity, const char* text) noexcept override;
  void tell_dropped(bool at_once) noexcept;  // how many lines were too many
  void transitioned(const std::string& from, const std::string& to, const std::string& why) noexcept override;
  void tell_refused() noexcept;  // what the control engine refused since the last time
  // The sets of all active machines that the snapshot does not show are asked for in the next tick.
  void want_sets(const Snapshot& snapshot) noexcept;
  // Runs one of the functions below under the tick's budget.
  bool run(int (*function)(lua_State*)) noexcept;

  Settings settings;
  const Catalog& catalog;
  BehaviorLog& log;
  LogBound bound;
  std::unique_ptr<LuaState> lua;
  Chart chart;
  Bindings bindings;
  RunnerTables tables;
  SnapshotTables snapshot_tables;
  std::unique_ptr<ChartRunner> runner;
  Transition transition;  // reused, so that its strings keep their room
  struct Rehearsal {
    const Snapshot* snapshot = nullptr;
    std::int64_t now_ns = 0;
    int function = LUA_NOREF;
  } rehearsal;
  ScriptError error;
  bool failed = false;
  std::uint64_t transactions_refused = 0;
  std::vector<InputProblem> problems;
};

struct Behavior::Past {
  std::unique_ptr<Parts> parts;
  std::vector<bool> left;  // its states that the swap left
  std::int64_t swapped_ns = 0;
  std::vector<LuaState::Source> taken_back;  // files that failed in their first second
  std::string complaint;                     // said last, not to be repeated
};

// Reads the file, makes the chart and the bindings. 0 instructions: as many as loading may take. Throws InputError.
void load_behavior(Behavior::Parts& parts, std::uint64_t instructions = 0);

// behavior_arguments.cpp. Gives the parameters of the behavior, and of those that it calls, the robot's values. Throws
// InputError.
void give_robot_values(Behavior::Parts& parts);

// behavior_arguments.cpp. Gives the behavior what Settings::arguments holds. Throws InputError.
void give_arguments(Behavior::Parts& parts, std::uint64_t instructions);

// behavior_adoption.cpp. Lets `fresh`, newly loaded, stand where `old` stands: active states, vars, parameters, random
// numbers; `old` is not changed. False: fresh.lua->error() says why.
bool adopt_behavior(Behavior::Parts& fresh, Behavior::Parts& old, const std::vector<StateIndex>& map,
                    const Snapshot& snapshot, CommandSender& commands) noexcept;
// [-0 +1] The `vars` of a machine, from its table.
void push_vars(lua_State* state, const RunnerTables::Machine& machine);
// Whether a machine goes on with vars of another version of it.
bool takes_vars(const Chart::Machine& machine, int version) noexcept;
// [-1] The machine's own vars are on the stack and those it had, of `version`, on top of them: the own ones become as
// those. Raises what `migrate` raises.
void give_vars(lua_State* state, const Chart::Machine& machine, int version);
// Leaves the states that are marked, in a transaction of its own. False: an exit raised.
bool leave_states(Behavior::Parts& parts, const std::vector<bool>& marks, const Snapshot& snapshot,
                  CommandSender& commands) noexcept;

}  // namespace kadans
