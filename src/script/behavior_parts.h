// What a behavior is made of; behavior_loading.cpp puts it together, behavior.cpp runs it.
#pragma once

#include <memory>
#include <string>

#include "bindings.h"
#include "kadans/script/behavior.h"
#include "kadans/script/chart_runner.h"
#include "kadans/script/lua_state.h"
#include "snapshot_tables.h"

namespace kadans {

struct Behavior::Parts final : ScriptVoice, TransitionSink {
  Parts(const Settings& wanted, const Catalog& offered, BehaviorLog& to);
  ~Parts() override = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void say(const char* text) noexcept override;
  void transitioned(const std::string& from, const std::string& to, const std::string& why) noexcept override;
  // Runs one of the functions below under the tick's budget.
  bool run(int (*function)(lua_State*)) noexcept;

  Settings settings;
  const Catalog& catalog;
  BehaviorLog& log;
  std::unique_ptr<LuaState> lua;
  Chart chart;
  Bindings bindings;
  RunnerTables tables;
  SnapshotTables snapshot_tables;
  std::unique_ptr<ChartRunner> runner;
  Transition transition;  // reused, so that its strings keep their room
  ScriptError error;
  bool failed = false, stopping = false;
  std::uint64_t transactions_refused = 0;
  std::vector<InputProblem> problems;
};

// Reads the file, makes the chart and the bindings. Throws InputError.
void load_behavior(Behavior::Parts& parts);

}  // namespace kadans
