#include "sweep_run.h"

#include <algorithm>
#include <cstdio>

#include "app/terminal.h"
#include "sweep_subjects.h"

namespace kadans {

SweepRun::SweepRun(const ExperimentConfig& plan, const std::vector<SweepSubject>& subjects, const SweepResults& results,
                   std::vector<SweepCase> cases, bool json, JobProgress::Log log)
    : plan_(plan),
      subjects_(subjects),
      results_(results),
      cases_(std::move(cases)),
      json_(json),
      progress_(std::max<std::size_t>(cases_.size(), 1), !json, log) {}

void SweepRun::run(std::size_t at_once) {
  const std::string program = run_program_path();
  std::vector<Job> jobs;
  for (const SweepCase& one : cases_) {
    const SweepSubject& subject = subjects_[one.subject];
    Job job{{program}, subject.wall_limit_s};
    std::ranges::move(run_arguments(one, subject.scenario.file), std::back_inserter(job.arguments));
    for (const char* option : {"--json", "--no-record"}) job.arguments.emplace_back(option);
    if (!plan_.metrics.empty()) {
      job.arguments.emplace_back("--metrics");
      job.arguments.push_back(plan_.file);
    }
    jobs.push_back(std::move(job));
  }
  run_jobs(jobs, at_once, *this);
  progress_.clear();
}

void SweepRun::ended(const JobOutcome& outcome) {
  const SweepCase& one = cases_[outcome.job];
  const SweepSubject& subject = subjects_[one.subject];
  RunOutcome run = read_run_outcome(outcome);
  if (run.status == RunStatus::cancelled) return;
  run.scenario = subject.name;
  run.file = subject.scenario.written;
  run.seed = one.seed;
  run.repeat = repeat_command(one, subject);
  const std::string line = case_json(results_.manifest(), one, run);
  results_.store(one, line);
  progress_.ended();
  if (!json_) return;
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
}

bool SweepRun::stop_asked() const { return interrupted(); }

}  // namespace kadans
