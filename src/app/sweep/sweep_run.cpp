#include "sweep_run.h"

#include <algorithm>
#include <cstdio>

#include "app/terminal.h"
#include "sweep_subjects.h"

namespace kadans {

JobProgress::JobProgress(std::size_t jobs, bool shown, Log log)
    : jobs_(jobs), on_terminal_(shown && stderr_is_terminal()), tenths_(shown && !on_terminal_ && log == Log::tenths) {}

void JobProgress::draw(std::size_t running) {
  if (!on_terminal_ && !tenths_) return;
  const double wall_s = elapsed_s();
  const bool due = on_terminal_ ? wall_s >= drawn_s_ + 0.1 : 10 * done_ / jobs_ > 10 * told_ / jobs_;
  if (!due) return;
  drawn_s_ = wall_s;
  told_ = done_;
  const double share = static_cast<double>(done_) / static_cast<double>(jobs_);
  std::fprintf(stderr, "%s  %zu of %zu, %zu running, %.0f s", on_terminal_ ? "\r\033[K" : "", done_, jobs_, running,
               wall_s);
  if (share > 0) std::fprintf(stderr, ", about %.0f s left", wall_s / share - wall_s);
  if (tenths_) std::fputc('\n', stderr);
  std::fflush(stderr);
}

void JobProgress::clear() const {
  if (on_terminal_ && drawn_s_ > 0) std::fputs("\r\033[K", stderr);
}

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
  failed_ = failed_ || run.status != RunStatus::passed;
  progress_.ended();
  if (!json_) return;
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
}

bool SweepRun::stop_asked() const { return interrupted(); }

}  // namespace kadans
