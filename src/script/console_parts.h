// What a console is made of; console_names.cpp holds what Lua sees, console.cpp runs lines and commands.
#pragma once

#include <string>
#include <vector>

#include "bindings.h"
#include "kadans/script/console.h"
#include "kadans/script/lua_state.h"
#include "snapshot_tables.h"

namespace kadans {

struct ConsoleBehavior {
  std::string name, state, outcome, error;
  std::vector<ScriptParameter> parameters;
};

// Names with dots as tables in tables, their values renewed together.
struct ValueTree {
  std::vector<std::string> names;  // sorted
  std::vector<std::size_t> ids;    // of the values, in the names' order
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
  int content = Chart::no_function;      // registry: what is there besides
  int show = Chart::no_function;         // registry: makes text of values

  bool writes = false;
  int line_number = 0;
  std::string pending;  // lines that are not complete yet
  int pending_line = 1;
  std::string printed;

  CommandQueue nowhere_queue;  // what is commanded while it only reads
  CommandSender nowhere{nowhere_queue};
};

// Makes the environment; the argument is the parts. Raises.
int open_console(lua_State* state);
// [-0 +0] Brings s, signals, parameters and behaviors up to date.
void refill_console(lua_State* state, Console::Parts& parts, const Console::View& view);
// The words that may stand at the end of the path: "signals.plant.ba".
std::vector<std::string> console_names(Console::Parts& parts, const std::string& path);

}  // namespace kadans
