// What `kadans test` is going to run, and what failed the last time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "commands.h"
#include "kadans/campaign/scenario_search.h"

namespace kadans {

// One run that is wanted.
struct PlannedRun {
  FoundScenario scenario;
  std::uint64_t seed = 1;
};

// What failed the last time, a "seed file" a line; one list for each project.
class FailedRuns {
 public:
  explicit FailedRuns(const std::filesystem::path& root);

  void read();
  // Those of these scenarios.
  std::vector<PlannedRun> of(const std::vector<FoundScenario>& scenarios) const;
  // A list that cannot be written is a comfort that is missing, no more.
  void write(const std::vector<PlannedRun>& failed) const;

 private:
  std::filesystem::path file_;
  std::vector<std::string> lines_;
};

// All seeds of all scenarios, or what failed of them; --seed and --repeat choose among the seeds.
std::vector<PlannedRun> plan_runs(const TestOptions& options, const std::vector<FoundScenario>& scenarios,
                                  FailedRuns& failed);

// Throws InputError when behavior check finds something in what they play.
void refuse_faulty_runs(const std::vector<PlannedRun>& runs);

// A line a run with its tags, and what it is about; or one JSON object a run.
void print_plan(const std::vector<PlannedRun>& runs, bool json);

}  // namespace kadans
