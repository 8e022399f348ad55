#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "commands.h"
#include "job_progress.h"
#include "kadans/campaign/durable_file.h"
#include "kadans/campaign/golden.h"
#include "kadans/campaign/scenario_search.h"
#include "kadans/campaign/suite_page.h"
#include "kadans/campaign/suite_report.h"
#include "kadans/config/project_root.h"
#include "line_editor.h"
#include "terminal.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// One run that is wanted.
struct PlannedRun {
  FoundScenario scenario;
  std::uint64_t seed = 1;
};

std::string repeat_command(const PlannedRun& run) {
  return "kadans sim " + run.scenario.file.string() + " --seed " + std::to_string(run.seed);
}

// What failed the last time, a "seed file" a line; one list for each project.
class FailedRuns {
 public:
  explicit FailedRuns(const fs::path& root)
      : file_(state_file("failed-" + std::to_string(std::hash<std::string>()(fs::absolute(root).string())))) {}

  bool contains(const PlannedRun& run) const { return std::ranges::find(lines_, line(run)) != lines_.end(); }
  void read() {
    std::ifstream stream(file_);
    for (std::string text; std::getline(stream, text);) lines_.push_back(text);
  }
  bool empty() const noexcept { return lines_.empty(); }
  // A list that cannot be written is a comfort that is missing, no more.
  void write(const std::vector<PlannedRun>& failed) const {
    if (file_.empty()) return;
    std::ofstream stream(file_);
    for (const PlannedRun& run : failed) stream << line(run) << '\n';
  }

 private:
  static std::string line(const PlannedRun& run) {
    return std::to_string(run.seed) + " " + fs::absolute(run.scenario.file).lexically_normal().string();
  }
  fs::path file_;
  std::vector<std::string> lines_;
};

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
      jobs.push_back({{fs::read_symlink("/proc/self/exe").string(), "sim", run.scenario.file.string(), "--seed",
                       std::to_string(run.seed), "--json", "--no-record"},
                      run.scenario.wall_limit_s});
      if (options_.report.wanted()) add_report(jobs.back());
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
  // Its process writes the page, so there is more to wait for.
  void add_report(Job& job) const {
    constexpr double drawing_s = 120;
    job.arguments.insert(job.arguments.end(),
                         {"--report", fs::absolute(options_.report.folder).string(), "--film", options_.report.film});
    job.wall_limit_s += drawing_s;
  }

  // Another state is a failure of a run that passes otherwise.
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

  // In the order of the plan, whatever order they ended in.
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
    if (options_.junit.empty()) return;
    std::ofstream file(options_.junit);
    file << junit_xml(outcomes, progress_.elapsed_s());
    file.close();
    if (!file) throw InputError({.file = options_.junit, .message = "cannot be written"});
  }

  const TestOptions& options_;
  std::vector<PlannedRun> runs_;
  GoldenHashes* golden_;  // or nullptr
  SuiteStyle style_;
  JobProgress progress_;
  bool stop_ = false;
  std::vector<std::pair<std::size_t, RunOutcome>> ended_;
};

std::vector<PlannedRun> plan(const TestOptions& options, const std::vector<FoundScenario>& scenarios) {
  std::vector<PlannedRun> runs;
  for (const FoundScenario& scenario : scenarios) {
    const std::uint64_t first = options.seed.value_or(scenario.seed);
    for (std::uint32_t i = 0; i < options.repeat.value_or(scenario.repeat); ++i) runs.push_back({scenario, first + i});
  }
  return runs;
}

void print_list(const std::vector<FoundScenario>& scenarios) {
  for (const FoundScenario& scenario : scenarios) {
    std::string tags;
    for (const std::string& tag : scenario.tags) tags += " #" + tag;
    std::printf("%s%s\n    %s\n", scenario.name.c_str(), tags.c_str(), scenario.doc.c_str());
  }
}

}  // namespace

int run_test(const TestOptions& options) {
  const fs::path root = project_root(fs::current_path() / "kadans");
  const fs::path folder = options.folder.empty() ? root / "config" / "scenarios" : fs::path(options.folder);
  const std::vector<FoundScenario> scenarios = find_scenarios(folder, options.selectors);
  if (scenarios.empty()) throw InputError({.file = folder.string(), .message = "there is no scenario here"});
  if (options.list) {
    print_list(scenarios);
    return exit_passed;
  }
  std::vector<PlannedRun> runs = plan(options, scenarios);
  FailedRuns failed_runs(root);
  if (options.rerun_failed) {
    failed_runs.read();
    std::erase_if(runs, [&](const PlannedRun& run) { return !failed_runs.contains(run); });
    if (runs.empty()) {
      std::puts("nothing failed the last time");
      return exit_passed;
    }
  }
  std::unique_ptr<GoldenHashes> golden;
  if (options.golden || options.renew_golden) golden = std::make_unique<GoldenHashes>(golden_file(folder));
  catch_interrupts();
  if (options.report.wanted()) fs::create_directories(options.report.folder);
  return Suite(options, std::move(runs), golden.get()).run(failed_runs);
}

}  // namespace kadans
