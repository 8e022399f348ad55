// The parts of a console. console_names.cpp makes the names that Lua sees, console.cpp runs lines and commands.
#pragma once

#include <string>
#include <vector>

#include "console.h"
#include "script/bindings/bindings.h"
#include "script/bindings/snapshot_tables.h"
#include "script/lua/lua_state.h"

namespace kadans {

struct ConsoleBehavior {
  std::string name, state, outcome, error;
  std::vector<ScriptParameter> parameters;
};

// Shows names with dots as nested tables; all values are refilled together.
struct ValueTree {
  std::vector<std::string> names;  // sorted
  std::vector<std::size_t> ids;    // ids of the values, in the names' order
  int slots = Chart::no_function;  // registry: table and key of each, in the names' order

  explicit ValueTree(const std::vector<std::string>& unsorted);
  void push(lua_State* state, const char* title);  // [-0 +1] raises
  void refill(lua_State* state, std::span<const double> values) const;
};

struct Console::Parts final : ScriptVoice {
  Parts(const Settings& settings, const Catalog& offered, ScriptHost& plays);
  ~Parts() override = default;
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  void say(const char* text) noexcept override { printed += std::string(text) + "\n"; }

  Settings settings;
  const Catalog& catalog;
  ScriptHost& host;
  LuaState lua;
  Chart chart;
  Bindings bindings;
  RunnerTables tables;
  SnapshotTables snapshot_tables;
  ValueTree signals, parameters;
  std::vector<ConsoleBehavior> behaviors;
  int environment = Chart::no_function;  // registry: the globals of the lines
  int content = Chart::no_function;      // registry: the console's own names
  int show = Chart::no_function;         // registry: the function that makes text of values

  bool writes = false;
  int line_number = 0;
  std::string pending;  // lines that do not form a complete statement yet
  int pending_line = 1;
  std::string printed;

  CommandQueue nowhere_queue;  // takes the commands while the console only reads
  CommandSender nowhere{nowhere_queue};
};

// Makes the environment. The argument on the stack is the Parts. Raises.
int open_console(lua_State* state);
// [-0 +0] Refills s, signals, parameters and behaviors.
void refill_console(lua_State* state, Console::Parts& parts, const Console::View& view);
// The completions of the last part of a path such as "signals.plant.ba".
std::vector<std::string> console_names(Console::Parts& parts, const std::string& path);

}  // namespace kadans
