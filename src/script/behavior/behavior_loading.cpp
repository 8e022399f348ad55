#include "behavior_parts.h"
#include "script/bindings/machine_sets.h"
#include "script/chart/chart_nodes.h"
#include "script/chart/chart_reader.h"
#include "script/chart/transition_lines.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

// Runs the file and reads the chart from what it returns.
int read_file(lua_State* state) {
  auto& parts = *static_cast<Behavior::Parts*>(lua_touserdata(state, 1));
  if (!parts.lua->load_file(state, parts.settings.file)) return lua_error(state);
  lua_call(state, 0, 1);
  const int result = lua_gettop(state);
  NodeKind kind{};
  if (!is_node(state, result, &kind) || kind != NodeKind::behavior) {
    return luaL_error(state, "%s:1: the file must return k.behavior \"name\" { ... }",
                      parts.lua->sources().front().chunk.c_str());
  }
  read_chart(state, result, parts.chart);
  return 0;
}

int open_bindings(lua_State* state) {
  auto& parts = *static_cast<Behavior::Parts*>(lua_touserdata(state, 1));
  open_machines(state, parts.chart, parts.bindings, parts.tables);
  parts.tables.snapshot = parts.snapshot_tables.open(state, parts.catalog, parts.settings.feet, true);
  return 0;
}

InputProblem problem_of(const ScriptError& error) { return {error.file.data(), error.line, 0, error.message.data()}; }

}  // namespace

void load_behavior(Behavior::Parts& parts, std::uint64_t instructions) {
  const Behavior::Settings& settings = parts.settings;
  if (instructions == 0) instructions = settings.limits.load_instructions;
  parts.lua = std::make_unique<LuaState>(LuaState::Settings{.root = settings.root,
                                                            .folder = settings.file.parent_path(),
                                                            .name = settings.file.stem().string(),
                                                            .seed = settings.seed,
                                                            .limits = settings.limits,
                                                            .voice = &parts});
  parts.bindings.catalog = &parts.catalog;
  parts.lua->core().bindings = &parts.bindings;
  if (!parts.lua->call(read_file, &parts, instructions, settings.limits.load_wall_ns)) {
    throw InputError(problem_of(parts.lua->error()));
  }
  find_transition_lines(parts.lua->sources(), parts.chart);
  parts.chart.resolve(parts.problems);
  find_control_sets(parts);
  if (!parts.problems.empty()) throw InputError(parts.problems);
  give_robot_values(parts);
  give_arguments(parts, instructions);
  if (!parts.lua->call(open_bindings, &parts, instructions, settings.limits.load_wall_ns)) {
    throw InputError(problem_of(parts.lua->error()));
  }
  parts.runner = std::make_unique<ChartRunner>(parts.chart, parts.tables, parts);
  parts.bindings.runner = parts.runner.get();
  parts.lua->core().loading = false;
}

}  // namespace kadans
