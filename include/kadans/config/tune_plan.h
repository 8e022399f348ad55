// A tuning: parameters of control objects that are to be found so that a metric of scenarios becomes as small as it
// can be over many randomised runs, in one JSON file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kadans/config/experiment_config.h"

namespace kadans {

// One number that is sought; all parameters that the pattern chooses get it.
struct TunedParameter {
  PlacedName pattern;           // "control.posture.*_knee.kp_Nm_per_rad"
  Distribution range;           // uniform or log_uniform between the least and the greatest value
  std::optional<double> start;  // else what the robot's configuration says
};

struct TunePlan : ExperimentConfig {
  std::vector<TunedParameter> tune;
  std::uint32_t runs = 8;         // of each candidate, the same for all
  std::uint32_t check_runs = 40;  // of before and after, others than those
  std::uint32_t population = 8;   // candidates of a generation
  std::uint32_t generations = 20;
  double step = 0.25;       // first spread of the candidates, as a share of the ranges
  PlacedName score;         // metric
  bool greatest = false;    // its greatest value is sought instead of its least
  double failed_score = 0;  // what a run counts that did not pass or has no value
};

// Throws InputError with everything that is wrong; scenarios are there, but not yet read.
TunePlan read_tune_plan(const std::filesystem::path& file);
TunePlan read_tune_plan_text(const std::string& text, const std::string& file);

// The fields of the file, for the schema.
FieldInfo describe_tune_plan();

}  // namespace kadans
