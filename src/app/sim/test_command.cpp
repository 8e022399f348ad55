// `kadans test`: plans the runs of scenarios, among them those that failed the last time, makes them and reports.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
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
#include "scenario/report/html_report.h"
#include "script/check/check_behavior.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

struct TestOptions {
  std::vector<std::string> selectors;  // files, folders, tags, names
  std::string folder;                  // where scenarios are searched; "": config/scenarios of the project
  unsigned jobs = 0;                   // 0: one for each core
  std::optional<std::uint32_t> repeat;
  std::optional<std::uint64_t> seed;
  bool fail_fast = false, rerun_failed = false, list = false, json = false;
  bool golden = false;        // state hashes must equal those of the golden file
  bool renew_golden = false;  // write them to the golden file instead
  std::string junit;
  ReportOptions report;
};

// One run to be made.
struct PlannedRun {
  const ScenarioConfig* scenario = nullptr;
  std::uint64_t seed = 1;
};

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

// As it stands in the list of the runs that failed the last time.
std::string line_of(const PlannedRun& run) {
  return std::to_string(run.seed) + " " + fs::absolute(run.scenario->file).lexically_normal().string();
}

std::vector<PlannedRun> runs_in(const std::vector<std::string>& lines, const std::vector<ScenarioConfig>& scenarios) {
  std::vector<PlannedRun> runs;
  for (const ScenarioConfig& scenario : scenarios) {
    for (const std::string& line : lines) {
      const PlannedRun run{&scenario, number_of<std::uint64_t>(line.substr(0, line.find(' '))).value_or(0)};
      if (line == line_of(run)) runs.push_back(run);
    }
  }
  return runs;
}

// Records, reports and golden hashes go by the names of scenarios.
void refuse_shared_names(const std::vector<ScenarioConfig>& scenarios) {
  std::map<std::string, const ScenarioConfig*> by_page;
  std::vector<InputProblem> problems;
  for (const ScenarioConfig& scenario : scenarios) {
    const auto [other, added] = by_page.emplace(report_file(scenario.name, 0), &scenario);
    if (!added)
      problems.push_back({.file = scenario.file,
                          .message = "name '" + scenario.name + "': " + other->second->file + " has the name '" +
                                     other->second->name + "': what is kept of their runs would be one"});
  }
  if (!problems.empty()) throw InputError(problems);
}

// All seeds of all scenarios, or with --rerun-failed the failed ones; --seed and --repeat choose the seeds.
std::vector<PlannedRun> plan_runs(const TestOptions& options, const std::vector<ScenarioConfig>& scenarios,
                                  const fs::path& failed) {
  std::vector<PlannedRun> runs;
  for (const ScenarioConfig& scenario : scenarios) {
    const std::uint64_t first = options.seed.value_or(scenario.seed);
    for (std::uint32_t i = 0; i < options.repeat.value_or(scenario.repeat); ++i) runs.push_back({&scenario, first + i});
  }
  if (!options.rerun_failed) return runs;
  std::vector<PlannedRun> again = runs_in(kept_lines(failed), scenarios);
  if (!options.seed && !options.repeat) return again;
  std::erase_if(again, [&](const PlannedRun& run) {
    return std::ranges::none_of(
        runs, [&](const PlannedRun& other) { return other.seed == run.seed && other.scenario == run.scenario; });
  });
  return again;
}

// Throws InputError when `behavior check` finds problems in the behaviors that the runs play.
void refuse_faulty_runs(const std::vector<PlannedRun>& runs) {
  std::map<fs::path, KnownRobot> robots;
  std::set<const ScenarioConfig*> seen;
  std::vector<InputProblem> problems;
  for (const PlannedRun& run : runs) {
    if (!seen.insert(run.scenario).second) continue;
    const ScenarioConfig& scenario = *run.scenario;
    if (!scenario.record.empty()) continue;  // it has its own behaviors
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
    const ScenarioConfig& scenario = *run.scenario;
    if (json) {
      const nlohmann::ordered_json line{{"scenario", scenario.name},
                                        {"seed", run.seed},
                                        {"file", scenario.file},
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

std::string repeat_command(const PlannedRun& run) {
  return "kadans sim " + shell_word(run.scenario->file) +
         (run.scenario->record.empty() ? " --seed " + std::to_string(run.seed) : "");
}

class Suite final : public JobWatcher {
 public:
  Suite(const TestOptions& options, std::vector<PlannedRun> runs, GoldenHashes* golden)
      : options_(options),
        runs_(std::move(runs)),
        golden_(golden),
        style_{.color = stdout_takes_color(), .unicode = true},
        progress_(runs_.size(), !options.json) {}

  int run(const fs::path& failed_file) {
    std::vector<Job> jobs;
    for (const PlannedRun& run : runs_) {
      jobs.push_back({{fs::read_symlink("/proc/self/exe").string(), "sim", run.scenario->file, "--json"},
                      run.scenario->wall_limit_s});
      const bool simulated = run.scenario->record.empty();
      if (simulated) {
        const std::vector<std::string> more{"--no-record", "--seed", std::to_string(run.seed)};
        jobs.back().arguments.insert(jobs.back().arguments.end(), more.begin(), more.end());
      }
      if (simulated && options_.report.wanted()) add_report(jobs.back());
      if (golden_ != nullptr) jobs.back().arguments.insert(jobs.back().arguments.end(), {"--hash-every", "1"});
    }
    run_jobs(jobs, options_.jobs, *this);
    progress_.clear();
    report(failed_file);
    if (interrupted()) return exit_interrupted;
    return failed() ? exit_failed : exit_passed;
  }

  void ended(const JobOutcome& outcome) override {
    const PlannedRun& planned = runs_[outcome.job];
    RunOutcome run = read_run_outcome(outcome);
    progress_.ended();
    run.scenario = planned.scenario->name;
    run.file = planned.scenario->file;
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
  void report(const fs::path& failed_file) {
    std::ranges::sort(ended_, {}, [](const auto& e) { return e.first; });
    std::vector<RunOutcome> outcomes;
    std::vector<std::string> failures;
    for (auto& [job, run] : ended_) {
      if (run.status != RunStatus::passed && run.status != RunStatus::cancelled)
        failures.push_back(line_of(runs_[job]));
      outcomes.push_back(std::move(run));
    }
    if (!interrupted()) keep_lines(failed_file, failures);
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
  ReportStyle style_;
  JobProgress progress_;
  bool stop_ = false;
  std::vector<std::pair<std::size_t, RunOutcome>> ended_;
};

// The configurations of all robots in these scenarios.
std::vector<fs::path> robots_of(const std::vector<ScenarioConfig>& scenarios) {
  std::set<fs::path> robots;
  for (const ScenarioConfig& scenario : scenarios) {
    if (!scenario.record.empty()) continue;
    robots.insert(scenario.robot);
    for (const ScenarioConfig& other : scenario.robots) robots.insert(other.robot);
  }
  return {robots.begin(), robots.end()};
}

int run_test(const TestOptions& options) {
  const fs::path root = project_root(fs::current_path() / "kadans");
  const fs::path folder = options.folder.empty() ? root / "config" / "scenarios" : fs::path(options.folder);
  const std::vector<ScenarioConfig> scenarios = find_scenarios(folder, options.selectors);
  if (scenarios.empty()) refuse(folder, "there is no scenario here");
  const fs::path failed_file = state_file("failed-" + std::to_string(std::hash<std::string>()(fs::absolute(root))));
  refuse_shared_names(scenarios);
  std::vector<PlannedRun> runs = plan_runs(options, scenarios, failed_file);
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
  const std::vector<std::string> contents = delivery_hashes(robots);
  const int code = Suite(options, std::move(runs), golden.get()).run(failed_file);
  // Whoever changes a file meanwhile has tested neither the one nor the other.
  if (code == exit_passed && delivery_hashes(robots) == contents) keep_passed(root, contents);
  return code;
}

}  // namespace

void add_test(CommandLine& line) {
  const auto [test, options] =
      line.add<TestOptions>("test", "Run scenarios in parallel, and report which failed and why", run_test);
  test->add_option("selectors", options.selectors, "Files, folders, tags, or names of scenarios (default: all)")
      ->type_name("PATH|TAG|NAME...");
  test->add_option("--in", options.folder, "Folder of scenarios (default: config/scenarios)")->type_name("FOLDER");
  add_jobs(*test, options.jobs);
  add_whole(*test, "--repeat", options.repeat, 1, 1'000'000, "Runs of each scenario, each with the next seed");
  add_seed(*test, options.seed, "First seed (default: each scenario's)");
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

}  // namespace kadans
