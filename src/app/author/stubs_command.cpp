#include <cmath>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "behavior_stage.h"
#include "signal/durable_file.h"
#include "config/json/foreign_json.h"
#include "config/robot/project_root.h"
#include "script/bindings/api.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr const char* luarc = R"({
  "runtime.version": "LuaJIT",
  "workspace.library": ["."],
  "diagnostics.globals": ["describe", "it", "before_each", "expect"]
}
)";

struct Row {
  std::string name, unit, doc;
  double value = 0, min = 0, max = 0;
};

std::vector<Row> rows_of_robot(const std::string& file) {
  const Robot robot = read_robot(file);
  const auto system = make_control_system(robot);
  const ParameterTable& table = system->catalog.parameters;
  std::vector<Row> rows;
  for (ParameterId id = 0; id < table.size(); ++id) {
    const Parameter& info = table.info(id);
    rows.push_back({info.name, info.unit, info.doc, table.get(id), info.min, info.max});
  }
  return rows;
}

std::vector<Row> rows_of_behavior(const ParamsOptions& options) {
  (void)read_input_file(options.file);  // throws when it does not exist
  const Robot robot = read_robot(options.robot.empty() ? robot_of_behavior(options.file) : fs::path(options.robot));
  const auto system = make_control_system(robot);
  RunLog log;
  const Behavior behavior({.root = project_root(options.file), .file = fs::absolute(options.file)}, system->catalog,
                          log);
  std::vector<Row> rows;
  for (const ScriptParameter& each : behavior.parameters()) {
    rows.push_back({each.name, each.unit, each.doc, each.value, each.min, each.max});
  }
  return rows;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

void print_json(const std::vector<Row>& rows) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    all.push_back({{"name", row.name},
                   {"value", number(row.value)},
                   {"unit", row.unit},
                   {"min", number(row.min)},
                   {"max", number(row.max)},
                   {"doc", row.doc}});
  }
  std::puts(json_text(all).c_str());
}

}  // namespace

void add_stubs(CLI::App& app, StubsOptions& options) {
  CLI::App* stubs = app.add_subcommand("lua-stubs", "Write the files with which editors complete and check behaviors");
  stubs->add_option("--robot", options.robot, "Robot whose names they contain (default: the only one of the project)")
      ->type_name("FILE");
  stubs->add_option("--output", options.output, "Folder for kadans.lua and .luarc.json")->type_name("DIR");
  stubs->add_flag("--markdown", options.markdown, "Print the reference instead");
}

int run_stubs(const StubsOptions& options) {
  if (options.markdown) {
    std::fputs(api_reference(project_root(fs::current_path() / "behaviors")).c_str(), stdout);
    return exit_passed;
  }
  const Robot robot = read_robot(options.robot.empty() ? only_robot(fs::current_path()) : fs::path(options.robot));
  const auto system = make_control_system(robot);
  fs::create_directories(options.output);
  write_durably(fs::path(options.output) / "kadans.lua", lua_stubs(system->catalog));
  write_durably(fs::path(options.output) / ".luarc.json", luarc);
  std::printf("wrote %s and .luarc.json\n", (fs::path(options.output) / "kadans.lua").c_str());
  return exit_passed;
}

void add_params(CLI::App& app, ParamsOptions& options) {
  CLI::App* params = app.add_subcommand("params", "List the parameters of a behavior or a robot");
  params->add_option("file", options.file, "Behavior (Lua) or robot configuration (JSON)")
      ->required()
      ->type_name("FILE");
  params->add_option("--robot", options.robot, "Robot of the behavior (default: the one of its folder)")
      ->type_name("FILE");
  params->add_flag("--json", options.json, "Print one JSON array instead of text");
}

int run_params(const ParamsOptions& options) {
  const bool behavior = fs::path(options.file).extension() == ".lua";
  const std::vector<Row> rows = behavior ? rows_of_behavior(options) : rows_of_robot(options.file);
  if (options.json) {
    print_json(rows);
    return exit_passed;
  }
  for (const Row& row : rows) {
    print_text(printed("%-40s %10g %-8s %g..%g  ", row.name.c_str(), row.value, row.unit.c_str(), row.min, row.max) +
               row.doc + "\n");
  }
  return exit_passed;
}

}  // namespace kadans
