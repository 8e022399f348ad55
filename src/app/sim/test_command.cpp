// `kadans test`: plans the runs of scenarios, among them those that failed the last time, makes them and reports.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly/robot.h"
#include "app/commands.h"
#include "app/line_editor.h"
#include "app/option_checks.h"
#include "app/push/tested_contents.h"
#include "app/sweep/sweep_run.h"
#include "app/terminal.h"
#include "campaign/suite/golden.h"
#include "campaign/suite/scenario_search.h"
#include "campaign/suite/suite_report.h"
#include "config/json/foreign_json.h"
#include "config/robot/project_root.h"
#include "input_files.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/shell_word.h"
#include "played_behaviors.h"
#include "script/check/check_behavior.h"
#include "signal/durable_file.h"
#include "signal/number_text.h"

namespace kadans {

// One run to be made.
struct PlannedRun {
  FoundScenario scenario;
  std::uint64_t seed = 1;
};

// The runs that failed the last time: a file with a line "seed file" for each; one file for each project.
class FailedRuns {
 public:
  explicit FailedRuns(const std::filesystem::path& root);

  void read();
  // The failed runs of these scenarios.
  std::vector<PlannedRun> of(const std::vector<FoundScenario>& scenarios) const;
  // Errors of writing are ignored, because the list is only a convenience.
  void write(const std::vector<PlannedRun>& failed) const;

 private:
  std::filesystem::path file_;
  std::vector<std::string> lines_;
};

namespace {

namespace fs = std::filesystem;

// A robot that is read once for all its scenarios. A robot that cannot be read is left to the processes of its runs;
// and so is one with plug-ins, whose native code may do anything.
struct KnownRobot {
  bool tried = false;
  Robot robot;
  std::unique_ptr<ControlSystem> system;

  const Catalog* catalog(const fs::path& file) {
    if (!std::exchange(tried, true)) {
      try {
        if (!read_plugin_files(file).empty()) return nullptr;
        robot = read_robot(file);
        system = make_control_system(robot);
      } catch (const InputError&) {
      }
    }
    return system ? &system->catalog : nullptr;
  }
};

std::string place_of(const FoundScenario& scenario) { return fs::absolute(scenario.file).lexically_normal().string(); }

}  // namespace

FailedRuns::FailedRuns(const fs::path& root)
    : file_(state_file("failed-" + std::to_string(std::hash<std::string>()(fs::absolute(root).string())))) {}

void FailedRuns::read() {
  std::ifstream stream(file_);
  for (std::string text; std::getline(stream, text);) lines_.push_back(text);
}

std::vector<PlannedRun> FailedRuns::of(const std::vector<FoundScenario>& scenarios) const {
  std::vector<PlannedRun> runs;
  for (const FoundScenario& scenario : scenarios) {
    for (const std::string& line : lines_) {
      const std::size_t blank = std::min(line.find(' '), line.size());
      const auto seed = number_of<std::uint64_t>(line.substr(0, blank));
      if (seed && line.substr(std::min(blank + 1, line.size())) == place_of(scenario))
        runs.push_back({scenario, *seed});
    }
  }
  return runs;
}

void FailedRuns::write(const std::vector<PlannedRun>& failed) const {
  if (file_.empty()) return;
  std::string text;
  for (const PlannedRun& run : failed) text += std::to_string(run.seed) + " " + place_of(run.scenario) + "\n";
  try {
    write_durably(file_, text);
  } catch (const InputError&) {
  }
}

// All seeds of all scenarios, or with --rerun-failed the failed ones; --seed and --repeat choose the seeds.
std::vector<PlannedRun> plan_runs(const TestOptions& options, const std::vector<FoundScenario>& scenarios,
                                  FailedRuns& failed) {
  std::vector<PlannedRun> runs;
  for (const FoundScenario& scenario : scenarios) {
    const std::uint64_t first = options.seed.value_or(scenario.seed);
    for (std::uint32_t i = 0; i < options.repeat.value_or(scenario.repeat); ++i) runs.push_back({scenario, first + i});
  }
  if (!options.rerun_failed) return runs;
  failed.read();
  std::vector<PlannedRun> again = failed.of(scenarios);
  if (!options.seed && !options.repeat) return again;
  const auto chosen = [&](const PlannedRun& run) {
    return std::ranges::any_of(runs, [&](const PlannedRun& other) {
      return other.seed == run.seed && other.scenario.file == run.scenario.file;
    });
  };
  std::erase_if(again, [&](const PlannedRun& run) { return !chosen(run); });
  return again;
}

// Throws InputError when `behavior check` finds problems in the behaviors that the runs play.
void refuse_faulty_runs(const std::vector<PlannedRun>& runs) {
  std::map<fs::path, KnownRobot> robots;
  std::set<fs::path> seen;
  std::vector<InputProblem> problems;
  for (const PlannedRun& run : runs) {
    if (!seen.insert(run.scenario.file).second) continue;
    if (!run.scenario.record.empty()) continue;  // it has its own behaviors
    const ScenarioConfig scenario = read_scenario_config(run.scenario.file);
    const Catalog* const catalog = robots[scenario.robot].catalog(scenario.robot);
    if (catalog == nullptr) continue;
    for (InputProblem& problem : problems_of_played(scenario, *catalog)) problems.push_back(std::move(problem));
  }
  tell_once(problems);
  if (!problems.empty()) throw InputError(problems);
}

// Prints for each run its name and tags and a line with its doc; or one JSON object.
void print_plan(const std::vector<PlannedRun>& runs, bool json) {
  for (const PlannedRun& run : runs) {
    const FoundScenario& scenario = run.scenario;
    if (json) {
      const nlohmann::ordered_json line{{"scenario", scenario.name},
                                        {"seed", run.seed},
                                        {"file", scenario.file.string()},
                                        {"tags", scenario.tags},
                                        {"doc", scenario.doc}};
      std::puts(json_text(line).c_str());
      continue;
    }
    std::string tags;
    for (const std::string& tag : scenario.tags) tags += " #" + tag;
    std::printf("%s (seed %llu)%s\n    %s\n", scenario.name.c_str(), static_cast<unsigned long long>(run.seed),
                tags.c_str(), scenario.doc.c_str());
  }
}

namespace {

std::string repeat_command(const PlannedRun& run) {
  if (!run.scenario.record.empty()) return "kadans sim " + shell_word(run.scenario.file.string());
  return "kadans sim " + shell_word(run.scenario.file.string()) + " --seed " + std::to_string(run.seed);
}

class Suite final : public JobWatcher {
 public:
  Suite(const TestOptions& options, std::vector<PlannedRun> runs, GoldenHashes* golden)
      : options_(options),
        runs_(std::move(runs)),
        golden_(golden),
        style_{.color = stdout_takes_color(), .unicode = true},
        progress_(runs_.size(), !options.json) {}

  int run(const FailedRuns& failed_runs) {
    std::vector<Job> jobs;
    for (const PlannedRun& run : runs_) {
      jobs.push_back({{fs::read_symlink("/proc/self/exe").string(), "sim", run.scenario.file.string(), "--json"},
                      run.scenario.wall_limit_s});
      const bool simulated = run.scenario.record.empty();
      if (simulated) {
        const std::vector<std::string> more{"--no-record", "--seed", std::to_string(run.seed)};
        jobs.back().arguments.insert(jobs.back().arguments.end(), more.begin(), more.end());
      }
      if (simulated && options_.report.wanted()) add_report(jobs.back());
      if (golden_ != nullptr) jobs.back().arguments.insert(jobs.back().arguments.end(), {"--hash-every", "1"});
    }
    run_jobs(jobs, options_.jobs, *this);
    progress_.clear();
    report(failed_runs);
    if (interrupted()) return exit_interrupted;
    return failed() ? exit_failed : exit_passed;
  }

  void ended(const JobOutcome& outcome) override {
    const PlannedRun& planned = runs_[outcome.job];
    RunOutcome run = read_run_outcome(outcome);
    progress_.ended();
    run.scenario = planned.scenario.name;
    run.file = planned.scenario.file.string();
    run.seed = planned.seed;
    run.repeat = repeat_command(planned);
    if (options_.golden) check_golden(run);
    progress_.clear();
    if (options_.json) {
      std::puts(run_json(run).c_str());
    } else if (run.status != RunStatus::cancelled) {
      std::fputs(suite_line(run, style_).c_str(), stdout);
    }
    std::fflush(stdout);
    stop_ = stop_ || (options_.fail_fast && run.status != RunStatus::passed);
    ended_.emplace_back(outcome.job, std::move(run));
  }

  void passed_time(std::size_t running) override { progress_.draw(running); }
  bool stop_asked() const override { return stop_ || interrupted(); }

 private:
  // The process of the run writes the page, so it gets more time.
  void add_report(Job& job) const {
    constexpr double drawing_s = 120;
    job.arguments.insert(job.arguments.end(),
                         {"--report", fs::absolute(options_.report.folder).string(), "--film", options_.report.film});
    job.wall_limit_s += drawing_s;
  }

  // A run whose state hash differs has failed.
  void check_golden(RunOutcome& run) const {
    if (run.status != RunStatus::passed && run.status != RunStatus::failed) return;
    const std::string difference = golden_->difference(run);
    if (difference.empty()) return;
    run.errors.push_back(difference);
    run.status = RunStatus::failed;
  }

  void renew_golden(const std::vector<RunOutcome>& runs) const {
    const bool all = options_.selectors.empty() && !options_.rerun_failed && ended_.size() == runs_.size();
    const std::vector<std::string> changes = golden_->take(runs, all);
    golden_->write();
    std::FILE* const to = options_.json ? stderr : stdout;
    std::fprintf(to, "%s: %zu runs, %zu changes\n", golden_->file().c_str(), golden_->size(), changes.size());
    for (const std::string& change : changes) std::fprintf(to, "  %s\n", change.c_str());
  }

  bool failed() const {
    return ended_.size() < runs_.size() ||
           std::ranges::any_of(ended_, [](const auto& e) { return e.second.status != RunStatus::passed; });
  }

  // Reports the runs in the order of the plan, not in the order in which they ended.
  void report(const FailedRuns& failed_runs) {
    std::ranges::sort(ended_, {}, [](const auto& e) { return e.first; });
    std::vector<RunOutcome> outcomes;
    std::vector<PlannedRun> failures;
    for (auto& [job, run] : ended_) {
      if (run.status != RunStatus::passed && run.status != RunStatus::cancelled) failures.push_back(runs_[job]);
      outcomes.push_back(std::move(run));
    }
    if (!interrupted()) failed_runs.write(failures);
    if (!options_.json) std::fputs(suite_summary(outcomes, progress_.elapsed_s(), style_).c_str(), stdout);
    if (options_.renew_golden && !interrupted()) renew_golden(outcomes);
    if (options_.report.wanted()) {
      const fs::path page = fs::path(options_.report.folder) / "index.html";
      write_durably(page, suite_page(outcomes, progress_.elapsed_s(), page.parent_path()));
      std::fprintf(options_.json ? stderr : stdout, "report: %s\n", page.c_str());
    }
    if (!options_.junit.empty()) write_durably(options_.junit, junit_xml(outcomes, progress_.elapsed_s()));
  }

  const TestOptions& options_;
  std::vector<PlannedRun> runs_;
  GoldenHashes* golden_;  // or nullptr
  SuiteStyle style_;
  JobProgress progress_;
  bool stop_ = false;
  std::vector<std::pair<std::size_t, RunOutcome>> ended_;
};

}  // namespace

namespace {

// The configurations of all robots in these scenarios.
std::vector<fs::path> robots_of(const std::vector<FoundScenario>& scenarios) {
  std::set<fs::path> robots;
  for (const FoundScenario& found : scenarios) {
    if (!found.record.empty()) continue;
    const ScenarioConfig scenario = read_scenario_config(found.file);
    robots.insert(scenario.robot);
    for (const ScenarioConfig& other : scenario.robots) robots.insert(other.robot);
  }
  return {robots.begin(), robots.end()};
}

}  // namespace

void add_test(CLI::App& app, TestOptions& options) {
  CLI::App* test = app.add_subcommand("test", "Run scenarios in parallel, and report which failed and why");
  test->add_option("selectors", options.selectors, "Files, folders, tags, or names of scenarios (default: all)")
      ->type_name("PATH|TAG|NAME...");
  test->add_option("--in", options.folder, "Folder of scenarios (default: config/scenarios)")->type_name("FOLDER");
  test->add_option("-j,--jobs", options.jobs, "Runs at the same time (default: one a core)")
      ->type_name("N")
      ->check(whole_within(1, 1024));
  test->add_option("--repeat", options.repeat, "Runs of each scenario, each with the next seed")
      ->type_name("N")
      ->check(whole_within(1, 1'000'000));
  test->add_option("--seed", options.seed, "First seed (default: each scenario's)")->type_name("N")->check(any_seed());
  test->add_flag("--fail-fast", options.fail_fast, "Stop at the first failure");
  test->add_flag("--rerun-failed", options.rerun_failed, "Run only the scenarios that failed the last time");
  test->add_flag("--list", options.list, "List the scenarios, but do not run them");
  CLI::Option* golden =
      test->add_flag("--golden", options.golden, "Fail scenarios that end in another state than in FOLDER.golden.json");
  CLI::Option* renew =
      test->add_flag("--renew-golden", options.renew_golden, "Write the states into that file, and print the changes");
  renew->excludes(golden)->excludes(test->get_option("--seed"))->excludes(test->get_option("--repeat"));
  test->add_option("--junit", options.junit, "Write the results as JUnit XML")->type_name("FILE");
  add_report_options(*test, options.report,
                     "Write a page about each run into a folder, and index.html about all of them", "failed");
  test->add_flag("--json", options.json, "Print one JSON object a run instead of text");
}

int run_test(const TestOptions& options) {
  const fs::path root = project_root(fs::current_path() / "kadans");
  const fs::path folder = options.folder.empty() ? root / "config" / "scenarios" : fs::path(options.folder);
  const std::vector<FoundScenario> scenarios = find_scenarios(folder, options.selectors);
  if (scenarios.empty()) throw InputError({.file = folder.string(), .message = "there is no scenario here"});
  FailedRuns failed_runs(root);
  std::vector<PlannedRun> runs = plan_runs(options, scenarios, failed_runs);
  if (runs.empty()) std::fputs("nothing failed the last time\n", options.json ? stderr : stdout);
  if (options.list) print_plan(runs, options.json);
  if (runs.empty() || options.list) return exit_passed;
  refuse_faulty_runs(runs);
  std::unique_ptr<GoldenHashes> golden;
  if (options.golden || options.renew_golden)
    golden = std::make_unique<GoldenHashes>(golden_file(folder), bullet_build());
  catch_interrupts();
  if (options.report.wanted()) fs::create_directories(options.report.folder);
  const bool whole = options.selectors.empty() && !options.rerun_failed && options.folder.empty();
  const std::vector<fs::path> robots = whole ? robots_of(scenarios) : std::vector<fs::path>();
  const std::vector<std::string> contents = TestedContents::hashes_of(robots);
  const int code = Suite(options, std::move(runs), golden.get()).run(failed_runs);
  // Whoever changes a file meanwhile has tested neither the one nor the other.
  if (code == exit_passed && TestedContents::hashes_of(robots) == contents) TestedContents(root).keep(contents);
  return code;
}

}  // namespace kadans
