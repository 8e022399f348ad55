// The cases of a sweep: the points of its sample, which run each case is, and the name under which its result is
// stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/plan/experiment_plans.h"
#include "scenario/disturb/quantities.h"

namespace kadans {

// The points of a sample: for each case the values of the varying quantities.
//
// For each case, every axis has a number u in [0, 1), and the axis's distribution turns u into a value. So random
// draws, Latin hypercubes and grids differ only in how they choose u. Each axis has a random stream of its own, so its
// numbers do not change when other axes are added or taken away. Latin hypercube (McKay, Beckman and Conover, 1979):
// every axis is divided into n equal parts, and each part holds exactly one of the n cases.

// One axis of the sample: a number u for each case, and the quantities that get its value.
struct SampleAxis {
  std::string name;                // the pattern when all its quantities get the same value, else the quantity
  std::vector<std::string> names;  // full names of quantities
  Distribution distribution;
  std::uint32_t steps = 1;  // of a grid
};

// Resolves the plan's patterns over a robot's quantities. Adds a problem for a pattern that chooses nothing. In a grid
// each pattern is one axis. `randomise` is what the scenario itself draws; it is sampled too when the plan says
// sample_randomise. The plan's own axes come later and so win.
std::vector<SampleAxis> sample_axes(const SweepPlan& plan, const std::vector<Variation>& randomise,
                                    const std::vector<std::string>& quantities, Problems& problems);

// How many points a grid over the axes has.
std::size_t grid_points(const std::vector<SampleAxis>& axes);

// The numbers u: for each point one for each axis. `stream` names the random streams, so that several samples of one
// seed are independent.
std::vector<std::vector<double>> sample(Sampling sampling, const std::vector<SampleAxis>& axes, std::size_t points,
                                        std::uint64_t seed, const std::string& stream);

// The values at a point by the names of the axes, which may be patterns. A later entry wins over an earlier one.
std::vector<QuantityValue> settings_at(const std::vector<SampleAxis>& axes, const std::vector<double>& point);
// The same values by the full names of the quantities; each name stands once.
std::vector<QuantityValue> quantities_at(const std::vector<SampleAxis>& axes, const std::vector<double>& point);

// A scenario of the plan, with what is known only after its robot was assembled.
struct SweepSubject {
  ExperimentScenario scenario;
  std::string name;
  double wall_limit_s = 60;
  std::vector<Variation> randomise;
  std::vector<std::string> quantities;  // quantities that can be set
  std::uint64_t content = 0;            // hash of everything that the run depends on, except seed and settings
};

struct SweepCase {
  std::size_t index = 0;  // in the sweep
  std::size_t subject = 0;
  std::uint64_t seed = 0;                 // below 2^53, so that every reader of JSON holds it
  std::vector<QuantityValue> settings;    // names may be patterns
  std::vector<QuantityValue> quantities;  // the same values by full names
  std::string id;                         // hash of contents, seed, settings, metrics and the program's version
};

// Throws InputError for a pattern that chooses nothing, and for more cases than sweep_cases_max.
std::vector<SweepCase> sweep_cases(const SweepPlan& plan, const std::vector<SweepSubject>& subjects,
                                   const std::string& version);

// The arguments of `kadans` that make this run: "sim FILE --seed N --set NAME=VALUE ...", where FILE is `file`.
std::vector<std::string> run_arguments(const SweepCase& one, const std::string& file);
std::string repeat_command(const SweepCase& one, const SweepSubject& subject);

}  // namespace kadans
