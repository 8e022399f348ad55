// The points of a sample: for each case the values of what varies.
//
// Every axis is a number u of [0, 1) a case, which its distribution turns into a value, so plain random draws, Latin
// hypercubes and grids differ in the u alone. Each axis has a random stream of its own: what else varies makes no
// difference to it. Latin hypercube: McKay, Beckman and Conover, 1979: of n cases, each n-th part of every axis has
// exactly one.
#pragma once

#include <string>
#include <vector>

#include "kadans/config/sweep_plan.h"
#include "kadans/scenario/quantities.h"

namespace kadans {

// One number a case, and the quantities that get the value that belongs to it.
struct SampleAxis {
  std::string name;                // the pattern when its quantities go together, else the quantity
  std::vector<std::string> names;  // full names of quantities
  Distribution distribution;
  std::uint32_t steps = 1;  // of a grid
};

// Resolves patterns over a robot's quantities. Adds problems for patterns that choose nothing. In a grid each pattern
// is one axis. `randomise`: what the scenario draws, sampled too; the plan's own axes come later and so win.
std::vector<SampleAxis> sample_axes(const SweepPlan& plan, const std::vector<Variation>& randomise,
                                    const std::vector<std::string>& quantities, Problems& problems);

// How many points a grid over the axes has.
std::size_t grid_points(const std::vector<SampleAxis>& axes);

// points x axes numbers of [0, 1]. `stream` keeps samples of one seed apart.
std::vector<std::vector<double>> sample(Sampling sampling, const std::vector<SampleAxis>& axes, std::size_t points,
                                        std::uint64_t seed, const std::string& stream);

// What a point says to the run, by the axes' names, which may be patterns: what comes later wins.
std::vector<QuantityValue> settings_at(const std::vector<SampleAxis>& axes, const std::vector<double>& point);
// The same by the quantities' full names, each once.
std::vector<QuantityValue> quantities_at(const std::vector<SampleAxis>& axes, const std::vector<double>& point);

}  // namespace kadans
