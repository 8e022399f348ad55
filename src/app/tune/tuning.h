// A tuning, from its plan to the configuration that it finds. All evaluated results are kept in files, one folder for
// each generation. So every process that shares the folder makes the same search and evaluates its part of each
// generation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/sweep/tune_command.h"
#include "campaign/sweep/sweep_case.h"
#include "campaign/tuning/cma_es.h"

namespace kadans {

class Tuning {
 public:
  explicit Tuning(const TuneOptions& options);

  int run();

 private:
  enum class Progress { complete, interrupted, others_missing };
  // Evaluates this process's part of the cases in a folder below the tuning's, and waits for the other processes'
  // parts.
  Progress evaluate(const std::string& name, const std::vector<SweepCase>& cases, std::vector<CaseRow>& rows);
  Progress wait_for_others(const SweepResults& results, const std::vector<SweepCase>& cases) const;
  Progress search();
  void note_candidates(const std::string& name, const std::vector<std::vector<double>>& candidates) const;
  void tell_generation(const std::vector<double>& scores) const;
  void write_configuration(const std::vector<double>& values) const;
  void report(const std::vector<double>& values, const TuningEffect& effect) const;

  const TuneOptions& options_;
  TunePlan plan_;
  std::string version_;
  Robot robot_;
  std::vector<SweepSubject> subjects_;
  std::vector<TunedAxis> axes_;
  std::vector<SweepCase> runs_;
  CmaEs search_;
  Shard shard_;
  std::filesystem::path folder_, configuration_;
};

}  // namespace kadans
