// The parts of a behavior, and the functions that load them and carry their state over to another version, Lua state or
// process. behavior.cpp makes and runs them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lua.hpp>

#include "behavior.h"
#include "kadans/control/catalog.h"
#include "script/bindings/bindings.h"
#include "script/bindings/snapshot_tables.h"
#include "script/chart/chart_runner.h"
#include "script/lua/lua_state.h"
#include "signal/byte_order.h"

namespace kadans {

struct Behavior::Parts final : ScriptVoice {
  Parts(const Settings& wanted, const Catalog& offered, BehaviorLog& to);
  ~Parts() override = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void note(BehaviorLog::Severity severity, std::string_view text) noexcept;  // logs it as said in the present tick
  void say_with(BehaviorLog::Severity severity, const char* text) noexcept override;
  void tell_dropped(bool at_once) noexcept;  // logs how many lines were dropped
  void transitioned(const std::string& from, const std::string& to, const std::string& why) noexcept override;
  void tell_refused() noexcept;  // logs what the control engine has refused since the last call
  void tell_armed() noexcept;    // logs what became of armed transactions since the last call, and posts their events
  // Asks in the next tick for the control sets of the active states that are not active.
  void want_sets() noexcept;
  // Runs work(state) under the tick's budget.
  template <typename Work>
  bool run(Work work) noexcept {
    return lua->call(work, settings.limits.tick_instructions, settings.limits.tick_wall_ns);
  }

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
  Transition transition;      // reused, so that its strings keep their room
  int rehearsal = LUA_NOREF;  // registry: the function of rehearse_tick()
  struct Reports {            // what is going to be an event in the next step of the chart (chart.h)
    std::array<Refusal, refusals_shown> refused{};
    std::uint32_t refused_count = 0;
    void note(const Refusal& refusal) noexcept {
      if (refused_count < refused.size()) refused[refused_count++] = refusal;
    }
    bool queue_full = false;  // a transaction found no place
    std::uint64_t faults_seen = 0;
  } reports;
  ScriptError error;
  bool failed = false;
  std::uint64_t transactions_refused = 0;
  std::vector<InputProblem> problems;
};

struct Behavior::Past {
  std::unique_ptr<Parts> parts;
  std::vector<bool> left;  // its states that were left at the swap
  std::int64_t swapped_ns = 0;
  std::vector<LuaState::Source> taken_back;  // files that failed in their first second
  std::string complaint;                     // the last logged complaint, so that it is not repeated
};

// Makes the Lua state in which the file will be read.
void open_lua(Behavior::Parts& parts);
// Reads the file, makes the chart and the bindings. `instructions` 0: the limit for loading. Throws InputError.
void load_behavior(Behavior::Parts& parts, std::uint64_t instructions = 0);

// What a robot's file calls it: the chunk, or, when the behavior was reloaded from another file, that of its first one.
const std::string& first_name(const Behavior::Parts& parts, const std::string& chunk);

// Of a finished behavior: the result of its final state, as text that Lua can read; "" when it has none.
std::string result_text(const Behavior::Parts& parts);

// To be called in a tick, before the chart's: reports that an active state waits for become events. Raises.
void post_reports(lua_State* state, Behavior::Parts& parts);

// Writes what is carried over to another version, Lua state or process. Returns "", or what
// cannot be kept: vars hold something that is no plain data and no motion, or hold more than 256 kB.
std::string keep_behavior(Behavior::Parts& parts, ByteWriter& bytes);
// Lets the newly loaded `parts` continue from bytes of keep_behavior(). Optionally tries the guards of all active
// states, which then leave no trace. False: parts.error says why.
[[nodiscard]] bool go_on_with(Behavior::Parts& parts, ByteReader& bytes, const Snapshot& snapshot,
                              CommandSender& commands, std::uint64_t instructions, bool guards_tried) noexcept;

// The greatest depth of nested tables in vars and in copies of them.
inline constexpr int vars_depth_max = 16;

}  // namespace kadans
