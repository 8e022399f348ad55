// The plan of `kadans test`: the runs to be made, and the runs that failed the last time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/commands.h"
#include "campaign/suite/scenario_search.h"

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

// All seeds of all scenarios, or with --rerun-failed the failed ones; --seed and --repeat choose the seeds.
std::vector<PlannedRun> plan_runs(const TestOptions& options, const std::vector<FoundScenario>& scenarios,
                                  FailedRuns& failed);

// Throws InputError when `behavior check` finds problems in the behaviors that the runs play.
void refuse_faulty_runs(const std::vector<PlannedRun>& runs);

// Prints for each run its name and tags and a line with its doc; or one JSON object.
void print_plan(const std::vector<PlannedRun>& runs, bool json);

}  // namespace kadans
