#include "behavior_command.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include <CLI/CLI.hpp>

#include "app/assembly.h"
#include "app/terminal.h"
#include "behavior_stage.h"
#include "checked_files.h"
#include "config/robot/project_root.h"
#include "file_checks.h"
#include "realtime/machine/child_process.h"
#include "scenario/run_log.h"
#include "script/behavior/behavior.h"
#include "script/chart/chart_graph.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

fs::path robot_for(const fs::path& file, const BehaviorOptions& options) {
  return options.robot.empty() ? robot_of_behavior(file) : fs::path(options.robot);
}

int run_checks(const BehaviorOptions& options) {
  int code = exit_passed;
  FileChecks checks(options.robot, options.plugins);
  for (const CheckedFile& checked : files_to_check(options.files, true)) {
    try {
      std::printf("ok  %s  %s\n", checked.file.c_str(), checks.check_script_file(checked).c_str());
    } catch (const InputError& error) {
      print_problems(error);
      code = exit_usage;
    }
  }
  return code;
}

// Graphviz lays the graph out.
int draw_svg(const std::string& dot) {
  try {
    const ProgramOutput drawn = run_program({"dot", "-Tsvg"}, dot);
    std::fputs(drawn.out.c_str(), stdout);
    std::fputs(drawn.err.c_str(), stderr);
    if (drawn.exit_code == 0) return exit_passed;
    print_error("dot, of Graphviz, failed: take --format dot or mermaid");
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::no_such_file_or_directory) throw;
    print_error("svg is drawn by Graphviz: install the package graphviz, or take --format dot or mermaid");
  }
  return exit_usage;
}

int run_graph(const BehaviorOptions& options) {
  const std::string& file = options.files.front();
  (void)read_input_file(file);  // throws when it does not exist
  const Robot robot = read_robot(robot_for(file, options));
  const auto system = make_control_system(robot);
  RunLog log;
  const Behavior behavior({.root = project_root(file), .file = fs::absolute(file)}, system->catalog, log);
  if (options.format == "mermaid") {
    std::fputs(mermaid_graph(behavior.chart(), behavior.parameters()).c_str(), stdout);
    return exit_passed;
  }
  const std::string dot = dot_graph(behavior.chart(), behavior.parameters());
  if (options.format == "svg") return draw_svg(dot);
  std::fputs(dot.c_str(), stdout);
  return exit_passed;
}

void add_files(CLI::App* command, BehaviorOptions& options, const char* what) {
  command->add_option("files", options.files, what)->required()->type_name("FILE...");
  command->add_option("--robot", options.robot, "Robot of the behaviors (default: the one of their folder)")
      ->type_name("FILE");
}

}  // namespace

void add_behavior(CLI::App& app, BehaviorOptions& options) {
  CLI::App* behavior = app.add_subcommand("behavior", "Check, test and draw behaviors");
  behavior->require_subcommand(1);
  CLI::App* check = behavior->add_subcommand("check", "Report mistakes in behaviors, without running them");
  add_files(check, options, "Behaviors, modules and tests (Lua); folders, patterns");
  check->add_flag("--plugins", options.plugins, "Load the plug-ins that robots name; this runs code of the plug-ins");
  CLI::App* test =
      behavior->add_subcommand("test", "Run tests of behaviors on a robot without physics, in virtual time");
  add_files(test, options, "Tests (*_test.lua), or folders of them");
  test->add_option("--only", options.only, "Run only tests whose name, with that of `describe`, contains this text")
      ->type_name("TEXT");
  test->add_option("--junit", options.junit, "Write the results as JUnit XML")->type_name("FILE");
  test->add_flag("--json", options.json, "Print one JSON object a test instead of text");
  CLI::App* graph = behavior->add_subcommand("graph", "Draw a behavior's states and transitions");
  add_files(graph, options, "Behavior (Lua)");
  graph->get_option("files")->expected(1);
  graph->add_option("--format", options.format, "mermaid (default), dot, or svg (needs Graphviz)")
      ->check(CLI::IsMember({"mermaid", "dot", "svg"}));
}

int run_behavior(const CLI::App& app, const BehaviorOptions& options) {
  const CLI::App* behavior = app.get_subcommand("behavior");
  if (behavior->got_subcommand("graph")) return run_graph(options);
  return behavior->got_subcommand("check") ? run_checks(options) : run_behavior_test(options);
}

}  // namespace kadans
