#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly/robot.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "behavior_stage.h"
#include "campaign/suite/suite_report.h"
#include "config/json/foreign_json.h"
#include "config/robot/project_root.h"
#include "file_checks.h"
#include "realtime/machine/child_process.h"
#include "scenario/run.h"
#include "script/behavior/behavior.h"
#include "script/chart/chart_graph.h"
#include "signal/durable_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// `kadans behavior check | graph | test`: commands for the author of a behavior, before it moves a robot.
struct BehaviorOptions {
  std::vector<std::string> files;
  std::string robot;               // configuration; "": the one for the behavior's folder
  std::string format = "mermaid";  // format of the graph: mermaid, dot or svg
  std::string only;                // run only tests whose names contain this
  std::string junit;
  bool json = false;
  bool plugins = false;  // check loads plug-ins
};

// The test files: the named files, and all *_test.lua in the named folders.
std::vector<std::string> test_files(const std::vector<std::string>& named) {
  std::vector<std::string> files;
  for (const std::string& name : named) {
    if (!fs::is_directory(name)) {
      if (!name.ends_with("_test.lua")) refuse(name, "is no file of tests: those are called ..._test.lua");
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

class BehaviorTests {
 public:
  explicit BehaviorTests(const BehaviorOptions& options) : options_(options) {}

  int run(const std::vector<std::string>& files) {
    const auto began = std::chrono::steady_clock::now();
    for (const std::string& file : files) {
      if (interrupted()) return exit_interrupted;
      run(file);
    }
    if (cases_.empty() && !options_.only.empty()) refuse("--only", "no test has '" + options_.only + "' in its name");
    if (cases_.empty()) refuse(listed(files), "no tests: describe(NAME, function) and it(NAME, function) make them");
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    if (!options_.json)
      std::printf("%zu passed, %zu failed, %.0f ms\n", count(Verdict::passed), count(Verdict::failed),
                  1e3 * took.count());
    if (!options_.junit.empty()) write_durably(options_.junit, junit_document(cases_, took.count()));
    if (count(Verdict::error) > 0) return exit_usage;
    return count(Verdict::failed) == 0 ? exit_passed : exit_failed;
  }

 private:
  using Verdict = JunitCase::Verdict;

  std::size_t count(Verdict verdict) const {
    return static_cast<std::size_t>(std::ranges::count(cases_, verdict, &JunitCase::verdict));
  }

  // A file that does not load is reported, and the other files are still run.
  void run(const std::string& file) {
    RobotStages stages(options_.robot);
    bool named = false;
    try {
      for (const TestOutcome& test :
           run_behavior_tests(project_root(file), fs::absolute(file), stages, options_.only)) {
        if (!options_.json && !named) std::printf("%s\n", file.c_str());
        named = true;
        tell(file, test);
      }
    } catch (const InputError& error) {
      print_problems(error);
      cases_.push_back({.file = file,
                        .name = "loads",
                        .verdict = Verdict::error,
                        .type = "refused",
                        .message = error.problems().front().text(),
                        .text = error.what()});
      if (options_.json) print_json(cases_.back());
    }
  }

  void tell(const std::string& file, const TestOutcome& test) {
    const bool passed = test.problem.empty();
    cases_.push_back({.file = file,
                      .name = test.name,
                      .wall_s = test.wall_s,
                      .verdict = passed ? Verdict::passed : Verdict::failed,
                      .type = "failed",
                      .message = test.problem,
                      .text = test.problem});
    if (options_.json) return print_json(cases_.back());
    print_text((passed ? "  ok      " : "  FAILED  ") + test.name + "\n");
    if (!passed) print_text("          " + test.problem + "\n");
  }

  static void print_json(const JunitCase& one) {
    constexpr const char* verdicts[] = {"passed", "failed", "refused", "skipped"};
    const nlohmann::ordered_json json{{"file", one.file},
                                      {"test", one.name},
                                      {"status", verdicts[static_cast<std::size_t>(one.verdict)]},
                                      {"wall_s", one.wall_s},
                                      {"problem", one.message}};
    std::puts(json_text(json).c_str());
  }

  const BehaviorOptions& options_;
  std::vector<JunitCase> cases_;
};

int run_tests(const BehaviorOptions& options) {
  const std::vector<std::string> files = test_files(options.files);
  if (files.empty()) refuse(options.files.front(), "there is no *_test.lua in it");
  catch_interrupts();
  return BehaviorTests(options).run(files);
}

fs::path robot_for(const fs::path& file, const BehaviorOptions& options) {
  return options.robot.empty() ? robot_of_behavior(file) : fs::path(options.robot);
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

int check_behaviors(const BehaviorOptions& options) {
  return FileChecks(options.robot, options.plugins).print_all(options.files, true);
}

}  // namespace

void add_behavior(CommandLine& line) {
  CLI::App* behavior = line.app.add_subcommand("behavior", "Check, test and draw behaviors");
  behavior->require_subcommand(1);
  const auto add = [&](const char* name, const char* doc, int (*does)(const BehaviorOptions&), const char* files) {
    auto added = line.add<BehaviorOptions>(*behavior, name, doc, does);
    added.command->add_option("files", added.options.files, files)->required()->type_name("FILE...");
    added.command
        ->add_option("--robot", added.options.robot, "Robot of the behaviors (default: the one of their folder)")
        ->type_name("FILE");
    return added;
  };
  const auto check = add("check", "Report mistakes in behaviors, without running them", check_behaviors,
                         "Behaviors, modules and tests (Lua); folders, patterns");
  check.command->add_flag("--plugins", check.options.plugins,
                          "Load the plug-ins that robots name; this runs code of the plug-ins");
  const auto [test, tested] = add("test", "Run tests of behaviors on a robot without physics, in virtual time",
                                  run_tests, "Tests (*_test.lua), or folders of them");
  test->add_option("--only", tested.only, "Run only tests whose name, with that of `describe`, contains this text")
      ->type_name("TEXT");
  test->add_option("--junit", tested.junit, "Write the results as JUnit XML")->type_name("FILE");
  test->add_flag("--json", tested.json, "Print one JSON object a test instead of text");
  const auto [graph, drawn] = add("graph", "Draw a behavior's states and transitions", run_graph, "Behavior (Lua)");
  graph->get_option("files")->expected(1);
  graph->add_option("--format", drawn.format, "mermaid (default), dot, or svg (needs Graphviz)")
      ->check(CLI::IsMember({"mermaid", "dot", "svg"}));
}

}  // namespace kadans
