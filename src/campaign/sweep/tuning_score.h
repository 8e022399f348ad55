// The candidates of a tuning as cases of a sweep, and the scores of their runs.
#pragma once

#include <string>
#include <vector>

#include "config/plan/experiment_plans.h"
#include "kadans/campaign/statistics.h"
#include "sweep_case.h"
#include "sweep_results.h"

namespace kadans {

// A tuned parameter, the quantities of the robot that it chooses, and the value at which the search begins.
struct TunedAxis {
  TunedParameter parameter;
  std::vector<std::string> names;  // full names of quantities: "control.posture.l_knee.kp_Nm_per_rad"
  double start = 0;
};

// The values at a point of the unit cube, rounded to six digits: these are used in the runs and written to files.
std::vector<double> values_at(const std::vector<TunedAxis>& axes, const std::vector<double>& point);
// The point at which all parameters have their start.
std::vector<double> start_point(const std::vector<TunedAxis>& axes);

// The runs that every candidate makes: the same seeds, scenarios and points (common random numbers), so that candidates
// differ in their parameters alone. The search and the final check use different values of `seed`.
std::vector<SweepCase> common_runs(const TunePlan& plan, const std::vector<SweepSubject>& subjects, std::uint32_t runs,
                                   std::uint64_t seed, const std::string& version);

// All runs of all candidates, one candidate after the other. A candidate without values changes no parameter.
std::vector<SweepCase> candidate_cases(const std::vector<SweepCase>& runs, const std::vector<TunedAxis>& axes,
                                       const std::vector<std::vector<double>>& candidates);

// The score of a run; less is better.
double run_score(const TunePlan& plan, const CaseRow& row);
// The mean score of each candidate over its `runs` rows. The rows must be complete and in order.
std::vector<double> candidate_scores(const TunePlan& plan, const std::vector<CaseRow>& rows, std::size_t runs);

// Before and after, run by run on the same seeds.
struct TuningEffect {
  std::size_t runs = 0;
  std::size_t passed_before = 0, passed_after = 0;
  SampleStatistics before, after;
  SampleStatistics change;  // of the score in the plan's own sign, after minus before
};
// The first half of the rows are the runs before the tuning, the second half those after it.
TuningEffect tuning_effect(const TunePlan& plan, const std::vector<CaseRow>& rows);
std::string effect_text(const TunePlan& plan, const TuningEffect& effect);

}  // namespace kadans
