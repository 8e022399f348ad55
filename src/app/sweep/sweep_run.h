// Runs cases of a sweep in parallel, each in a process of its own, and stores their results.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "campaign/sweep/sweep_results.h"
#include "kadans/campaign/job_pool.h"

namespace kadans {

// A line on stderr about runs in parallel: how many are done and the estimated time left. On a terminal the line is
// drawn over. Elsewhere there is no line, or with Log::tenths one line for each tenth of the jobs.
class JobProgress {
 public:
  enum class Log { terminal_only, tenths };
  JobProgress(std::size_t jobs, bool shown, Log log = Log::terminal_only);

  void ended() noexcept { ++done_; }
  void draw(std::size_t running);  // call it a few times a second
  void clear() const;              // call it before anything else is printed
  double elapsed_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }

 private:
  std::size_t jobs_;
  bool on_terminal_, tenths_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::size_t done_ = 0, told_ = 0;
  double drawn_s_ = 0;
};

class SweepRun final : public JobWatcher {
 public:
  // Keeps references. `json`: prints each case as a line, without progress.
  SweepRun(const ExperimentConfig& plan, const std::vector<SweepSubject>& subjects, const SweepResults& results,
           std::vector<SweepCase> cases, bool json, JobProgress::Log log = JobProgress::Log::tenths);

  void run(std::size_t at_once);
  // Once a case failed, no further one is started. So the first failed one is the same however many run at once.
  void stop_at_failure() noexcept { stops_at_failure_ = true; }

  void ended(const JobOutcome& outcome) override;
  void passed_time(std::size_t running) override { progress_.draw(running); }
  bool stop_asked() const override;
  bool enough() const override { return stops_at_failure_ && failed_; }

 private:
  const ExperimentConfig& plan_;
  const std::vector<SweepSubject>& subjects_;
  const SweepResults& results_;
  std::vector<SweepCase> cases_;
  bool json_, stops_at_failure_ = false, failed_ = false;
  JobProgress progress_;
};

}  // namespace kadans
