// Candidates of a tuning as cases of a sweep, and what their runs are worth.
#pragma once

#include <string>
#include <vector>

#include "kadans/campaign/statistics.h"
#include "kadans/campaign/sweep_case.h"
#include "kadans/campaign/sweep_results.h"
#include "kadans/config/tune_plan.h"

namespace kadans {

// A tuned parameter with what it chooses in the robot and where its search begins.
struct TunedAxis {
  TunedParameter parameter;
  std::vector<std::string> names;  // full names of quantities: "control.posture.l_knee.kp_Nm_per_rad"
  double start = 0;
};

// The values of a point of the unit cube, of six digits, as they are run and written.
std::vector<double> values_at(const std::vector<TunedAxis>& axes, const std::vector<double>& point);
// The point at which all parameters have their start.
std::vector<double> start_point(const std::vector<TunedAxis>& axes);

// The runs that every candidate makes: the same seeds, scenarios and points (common random numbers), so that candidates
// differ in their parameters alone. `seed` tells the search's runs from those of the check.
std::vector<SweepCase> common_runs(const TunePlan& plan, const std::vector<SweepSubject>& subjects, std::uint32_t runs,
                                   std::uint64_t seed, const std::string& version);

// All runs of all candidates, one candidate after the other; nothing is set for a candidate without values.
std::vector<SweepCase> candidate_cases(const std::vector<SweepCase>& runs, const std::vector<TunedAxis>& axes,
                                       const std::vector<std::vector<double>>& candidates);

// What a run counts, the less the better.
double run_score(const TunePlan& plan, const CaseRow& row);
// The mean of `runs` rows for each candidate. The rows are complete and in order.
std::vector<double> candidate_scores(const TunePlan& plan, const std::vector<CaseRow>& rows, std::size_t runs);

// Before and after, run by run on the same seeds.
struct TuningEffect {
  std::size_t runs = 0;
  std::size_t passed_before = 0, passed_after = 0;
  SampleStatistics before, after;
  SampleStatistics change;  // of the score as the plan has it, after minus before
};
// The first half of the rows is before, the second after.
TuningEffect tuning_effect(const TunePlan& plan, const std::vector<CaseRow>& rows);
std::string effect_text(const TunePlan& plan, const TuningEffect& effect);

}  // namespace kadans
