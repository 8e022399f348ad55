// `kadans behavior test`.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <nlohmann/json.hpp>

#include "app/terminal.h"
#include "behavior_command.h"
#include "behavior_stage.h"
#include "campaign/suite/suite_report.h"
#include "campaign/work/durable_file.h"
#include "config/json/foreign_json.h"
#include "config/robot/project_root.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// The test files: the named files, and all *_test.lua in the named folders.
std::vector<std::string> test_files(const std::vector<std::string>& named) {
  std::vector<std::string> files;
  for (const std::string& name : named) {
    if (!fs::is_directory(name)) {
      if (!name.ends_with("_test.lua"))
        throw InputError({.file = name, .message = "is no file of tests: those are called ..._test.lua"});
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
    if (cases_.empty() && !options_.only.empty())
      throw InputError(InputProblem{.file = "--only", .message = "no test has '" + options_.only + "' in its name"});
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
    IdealStages stages(options_.robot);
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
    std::printf("  %s  %s\n", passed ? "ok    " : "FAILED", test.name.c_str());
    if (!passed) std::printf("          %s\n", test.problem.c_str());
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

}  // namespace

int run_behavior_test(const BehaviorOptions& options) {
  const std::vector<std::string> files = test_files(options.files);
  if (files.empty()) throw InputError({.file = options.files.front(), .message = "there is no *_test.lua in it"});
  catch_interrupts();
  return BehaviorTests(options).run(files);
}

}  // namespace kadans
