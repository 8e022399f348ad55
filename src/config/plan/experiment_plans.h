// Experiments, a JSON file each: scenarios that are run many times, as a sweep over a sample of their quantities, or as
// a tuning that searches parameters.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario/distribution.h"
#include "config/scenario/scenario_check.h"

namespace kadans {

// The common part of sweeps and tunings: the scenarios that are run many times, the quantities that vary from run to
// run, and the metrics that are measured.
struct ExperimentScenario {
  std::string written;  // as the plan names it
  std::string file;     // resolved
  TextPlace place;
};

// Quantities that vary, chosen by a pattern over their names.
struct ExperimentAxis {
  Variation variation;
  std::uint32_t steps = 5;  // points in a grid, when the distribution is continuous
};

struct ExperimentConfig {
  std::string file;
  std::string name;
  std::string doc;
  std::vector<ExperimentScenario> scenarios;
  std::uint64_t seed = 1;
  bool sample_randomise = false;  // samples what the scenarios randomise, too; else each run's seed draws it
  std::vector<ExperimentAxis> vary;
  std::vector<MetricConfig> metrics;
};

// Reads the metrics alone from the plan of a sweep or of a tuning, for `kadans sim --metrics`. Throws InputError.
std::vector<MetricConfig> read_metrics(const std::string& file);

// A sweep: scenarios run many times over a sample of their quantities, in one JSON file.
enum class Sampling : std::uint8_t { grid, random, latin_hypercube };

struct SweepPlan : ExperimentConfig {
  Sampling sampling = Sampling::random;
  std::uint32_t cases = 0;  // of all scenarios together; 0 with a grid: each point is run once
  bool same_seeds = false;  // one seed for all points of a grid's round, or for all scenarios at one sample point
  double passed_min = 1;    // share of cases that must pass
  PlacedName first_try;     // metric that is not 0 when the run passed at its first try
  PlacedName time;          // metric whose median is reported
  PlacedName worst;         // metric whose greatest values mark the worst cases
  struct HeatMap {
    PlacedName x, y;    // quantities
    PlacedName metric;  // "": the share that passed
  } heat_map;
};

constexpr std::uint32_t sweep_cases_max = 1'000'000;

const char* name(Sampling sampling) noexcept;

// Throws InputError with all mistakes. The scenarios' files exist, but they are not read yet.
SweepPlan read_sweep_plan(const std::filesystem::path& file);
SweepPlan read_sweep_plan_text(const std::string& text, const std::string& file);

// The fields of the file, for the schema.
FieldInfo describe_sweep_plan();

// A tuning, in one JSON file: it searches values for parameters of control objects that make a metric of the scenarios
// as small as possible over many randomised runs. Or a program of any kind takes the parameters and gives the metrics.

// One number that is searched; all parameters that the pattern chooses get it.
struct TunedParameter {
  PlacedName pattern;           // "control.posture.*_knee.kp_Nm_per_rad"
  Distribution range;           // uniform or log_uniform between the least and the greatest allowed value
  std::optional<double> start;  // without it, the search starts at the value in the robot's configuration
};

struct TunePlan : ExperimentConfig {
  // In place of scenarios: with PARAMETER=VALUE... appended, it prints the metrics as a JSON object in its last line.
  std::vector<PlacedName> program;
  std::vector<PlacedName> check_program;  // that judges the values found, in the same way; none: `program` does
  std::vector<TunedParameter> tune;
  std::uint32_t runs = 8;         // runs of each candidate; all candidates have the same ones
  std::uint32_t check_runs = 40;  // runs before and after the tuning, with other seeds
  std::uint32_t population = 8;   // candidates of a generation
  std::uint32_t generations = 20;
  double step = 0.25;       // first spread of the candidates, as a share of the ranges
  PlacedName score;         // metric
  bool greatest = false;    // the greatest value is searched instead of the least
  double failed_score = 0;  // score of a run that did not pass or has no value
};

// Throws InputError with all mistakes. The scenarios' files exist, but they are not read yet.
TunePlan read_tune_plan(const std::filesystem::path& file);
TunePlan read_tune_plan_text(const std::string& text, const std::string& file);

// The fields of the file, for the schema.
FieldInfo describe_tune_plan();

}  // namespace kadans
