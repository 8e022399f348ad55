#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly/robot.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "behavior_stage.h"
#include "config/json/foreign_json.h"
#include "config/robot/project_root.h"
#include "script/bindings/api.h"
#include "signal/durable_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// `kadans lua-stubs` and `kadans params`: show the tables of a robot and of a behavior, for editors and for people.
struct StubsOptions {
  std::string robot, output = ".";
  bool markdown = false;
};

struct ParamsOptions {
  std::string file, robot;
  bool json = false;
};

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

struct Tables {
  std::vector<Row> parameters{};
  std::vector<ScriptArgument> arguments{};
};

Tables tables_of_behavior(const ParamsOptions& options) {
  (void)read_input_file(options.file);  // throws when it does not exist
  const Robot robot = read_robot(options.robot.empty() ? robot_of_behavior(options.file) : fs::path(options.robot));
  const auto system = make_control_system(robot);
  RunLog log;
  const Behavior behavior({.root = project_root(options.file), .file = fs::absolute(options.file)}, system->catalog,
                          log);
  Tables tables{.arguments = behavior.arguments()};
  for (const ScriptParameter& each : behavior.parameters()) {
    tables.parameters.push_back({each.name, each.unit, each.doc, each.value, each.min, each.max});
  }
  return tables;
}

const char* type_of(const ScriptArgument& argument) {
  constexpr std::array types{"number", "boolean", "text"};
  return argument.initial ? types[argument.initial->index()] : "table";
}

nlohmann::ordered_json default_of(const ScriptArgument& argument) {
  if (!argument.initial) return nullptr;
  return std::visit([](const auto& value) { return nlohmann::ordered_json(value); }, *argument.initial);
}

// An argument has the key "argument", its type; its value is the default.
nlohmann::ordered_json json_of(const ScriptArgument& argument) {
  nlohmann::ordered_json one{{"name", argument.name}, {"argument", type_of(argument)}, {"value", default_of(argument)},
                             {"unit", argument.unit}, {"min", argument.min},           {"max", argument.max}};
  if (!argument.one_of.empty()) one["one_of"] = argument.one_of;
  one["doc"] = argument.doc;
  return one;
}

// "0.02..0.2", "one of left, right", "any text".
std::string allowed_by(const ScriptArgument& argument) {
  if (!argument.one_of.empty()) return "one of " + listed(argument.one_of);
  const bool bounded = std::isfinite(argument.min) || std::isfinite(argument.max);
  return bounded ? printed("%g..%g", argument.min, argument.max) : std::string("any ") + type_of(argument);
}

// What is not finite is written as null.
void print_json(const Tables& tables) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Row& row : tables.parameters) {
    all.push_back({{"name", row.name},
                   {"value", row.value},
                   {"unit", row.unit},
                   {"min", row.min},
                   {"max", row.max},
                   {"doc", row.doc}});
  }
  for (const ScriptArgument& argument : tables.arguments) all.push_back(json_of(argument));
  std::puts(json_text(all).c_str());
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

int run_params(const ParamsOptions& options) {
  const bool behavior = fs::path(options.file).extension() == ".lua";
  const Tables tables = behavior ? tables_of_behavior(options) : Tables{rows_of_robot(options.file)};
  if (options.json) {
    print_json(tables);
    return exit_passed;
  }
  for (const Row& row : tables.parameters) {
    print_text(printed("%-40s %10g %-8s %g..%g  ", row.name.c_str(), row.value, row.unit.c_str(), row.min, row.max) +
               row.doc + "\n");
  }
  if (!tables.arguments.empty()) print_text("arguments:\n");
  for (const ScriptArgument& argument : tables.arguments) {
    const std::string initial = argument.initial ? json_text(default_of(argument)) : "a table";
    print_text(printed("%-40s %10s %-8s ", argument.name.c_str(), initial.c_str(), argument.unit.c_str()) +
               allowed_by(argument) + "  " + argument.doc + "\n");
  }
  return exit_passed;
}

}  // namespace

void add_stubs(CommandLine& line) {
  const auto [stubs, options] =
      line.add<StubsOptions>("lua-stubs", "Write the files with which editors complete and check behaviors", run_stubs);
  stubs->add_option("--robot", options.robot, "Robot whose names they contain (default: the only one of the project)")
      ->type_name("FILE");
  stubs->add_option("--output", options.output, "Folder for kadans.lua and .luarc.json")->type_name("DIR");
  stubs->add_flag("--markdown", options.markdown, "Print the reference instead");
}

void add_params(CommandLine& line) {
  const auto [params, options] = line.add<ParamsOptions>(
      "params", "List the parameters of a behavior or a robot, and a behavior's arguments", run_params);
  params->add_option("file", options.file, "Behavior (Lua) or robot configuration (JSON)")
      ->required()
      ->type_name("FILE");
  params->add_option("--robot", options.robot, "Robot of the behavior (default: the one of its folder)")
      ->type_name("FILE");
  params->add_flag("--json", options.json, "Print one JSON array instead of text");
}

}  // namespace kadans
