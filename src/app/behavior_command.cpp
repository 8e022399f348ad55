#include "behavior_command.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "behavior_stage.h"
#include "kadans/app/assembly.h"
#include "kadans/config/project_root.h"
#include "kadans/scenario/run_log.h"
#include "kadans/script/behavior.h"
#include "kadans/script/chart_graph.h"
#include "kadans/script/check_behavior.h"
#include "terminal.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

fs::path robot_for(const fs::path& file, const BehaviorOptions& options) {
  return options.robot.empty() ? robot_of_behavior(file) : fs::path(options.robot);
}

void check(const std::string& file, const BehaviorOptions& options) {
  const Robot robot = read_robot(robot_for(file, options));
  const auto system = make_control_system(robot);
  const std::vector<InputProblem> problems = check_behavior(project_root(file), fs::absolute(file), system->catalog);
  if (!problems.empty()) throw InputError(problems);
  std::printf("ok  %s  fits %s\n", file.c_str(), robot.config.name.c_str());
}

int run_checks(const BehaviorOptions& options) {
  int code = exit_passed;
  for (const std::string& file : options.files) {
    try {
      check(file, options);
    } catch (const InputError& error) {
      print_problems(error);
      code = exit_usage;
    }
  }
  return code;
}

// The test files: those that were named, and in folders all *_test.lua.
std::vector<std::string> test_files(const std::vector<std::string>& named) {
  std::vector<std::string> files;
  for (const std::string& name : named) {
    if (!fs::is_directory(name)) {
      files.push_back(name);
      continue;
    }
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(name)) {
      if (entry.path().string().ends_with("_test.lua")) files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

int run_tests(const BehaviorOptions& options) {
  const auto began = std::chrono::steady_clock::now();
  std::size_t passed = 0, failed = 0;
  const std::vector<std::string> files = test_files(options.files);
  if (files.empty()) throw InputError({.file = options.files.front(), .message = "there is no *_test.lua in it"});
  for (const std::string& file : files) {
    IdealStages stages(options.robot);
    std::printf("%s\n", file.c_str());
    for (const TestOutcome& test : run_behavior_tests(project_root(file), fs::absolute(file), stages)) {
      std::printf("  %s  %s\n", test.problem.empty() ? "ok    " : "FAILED", test.name.c_str());
      if (!test.problem.empty()) std::printf("          %s\n", test.problem.c_str());
      ++(test.problem.empty() ? passed : failed);
    }
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  std::printf("%zu passed, %zu failed, %.0f ms\n", passed, failed, took.count());
  return failed == 0 ? exit_passed : exit_failed;
}

// Graphviz lays the graph out; the text goes to it through a file, its picture to our stdout.
int draw_svg(const std::string& dot) {
  const fs::path file = fs::temp_directory_path() / ("kadans-graph-" + std::to_string(::getpid()) + ".dot");
  std::ofstream(file) << dot;
  const int status = std::system(("dot -Tsvg '" + file.string() + "'").c_str());  // NOLINT: a program of its own
  fs::remove(file);
  if (status == 0) return exit_passed;
  print_error("svg is drawn by Graphviz: install the package graphviz, or take --format dot or mermaid");
  return exit_usage;
}

int run_graph(const BehaviorOptions& options) {
  const std::string& file = options.files.front();
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
  command->add_option("--robot", options.robot, "Robot that they are for (default: by their folder)")
      ->type_name("FILE");
}

}  // namespace

void add_behavior(CLI::App& app, BehaviorOptions& options) {
  CLI::App* behavior = app.add_subcommand("behavior", "Check, test and draw behaviors");
  behavior->require_subcommand(1);
  add_files(behavior->add_subcommand("check", "Say what is wrong in behaviors, without running them"), options,
            "Behaviors (Lua)");
  add_files(behavior->add_subcommand("test", "Run tests of behaviors on a robot without physics, in virtual time"),
            options, "Tests (*_test.lua), or folders of them");
  CLI::App* graph = behavior->add_subcommand("graph", "Draw a behavior's states and transitions");
  add_files(graph, options, "Behavior (Lua)");
  graph->get_option("files")->expected(1);
  graph->add_option("--format", options.format, "mermaid (default), dot, or svg (needs Graphviz)")
      ->check(CLI::IsMember({"mermaid", "dot", "svg"}));
}

int run_behavior(const CLI::App& app, const BehaviorOptions& options) {
  const CLI::App* behavior = app.get_subcommand("behavior");
  if (behavior->got_subcommand("graph")) return run_graph(options);
  return behavior->got_subcommand("check") ? run_checks(options) : run_tests(options);
}

}  // namespace kadans
