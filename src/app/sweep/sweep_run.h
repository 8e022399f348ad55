// Runs cases of a sweep in parallel, each in a process of its own, and stores their results.
#pragma once

#include <string>
#include <vector>

#include "campaign/sweep/sweep_results.h"
#include "campaign/work/job_pool.h"
#include "job_progress.h"

namespace kadans {

class SweepRun final : public JobWatcher {
 public:
  // Keeps references. `json`: prints each case as a line, without progress.
  SweepRun(const ExperimentConfig& plan, const std::vector<SweepSubject>& subjects, const SweepResults& results,
           std::vector<SweepCase> cases, bool json, JobProgress::Log log = JobProgress::Log::tenths);

  void run(std::size_t at_once);

  void ended(const JobOutcome& outcome) override;
  void passed_time(std::size_t running) override { progress_.draw(running); }
  bool stop_asked() const override;

 private:
  const ExperimentConfig& plan_;
  const std::vector<SweepSubject>& subjects_;
  const SweepResults& results_;
  std::vector<SweepCase> cases_;
  bool json_;
  JobProgress progress_;
};

}  // namespace kadans
