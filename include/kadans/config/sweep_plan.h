// A sweep: scenarios run many times over a sample of their quantities, in one JSON file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "kadans/config/experiment_config.h"

namespace kadans {

enum class Sampling : std::uint8_t { grid, random, latin_hypercube };

struct SweepPlan : ExperimentConfig {
  Sampling sampling = Sampling::random;
  std::uint32_t cases = 0;  // of all scenarios together; 0 with a grid: each point once
  bool same_seeds = false;  // all points of a grid's round, or all scenarios of a sample, share their seed
  double passed_min = 1;    // share of cases that must pass
  PlacedName first_try;     // metric that is not 0 in a run which passed at its first try
  PlacedName time;          // metric whose median is reported
  PlacedName worst;         // metric whose greatest values are the worst cases
  struct HeatMap {
    PlacedName x, y;    // quantities
    PlacedName metric;  // "": the share that passed
  } heat_map;
};

constexpr std::uint32_t sweep_cases_max = 1'000'000;

const char* name(Sampling sampling) noexcept;

// Throws InputError with everything that is wrong; scenarios are there, but not yet read.
SweepPlan read_sweep_plan(const std::filesystem::path& file);
SweepPlan read_sweep_plan_text(const std::string& text, const std::string& file);

// The fields of the file, for the schema.
FieldInfo describe_sweep_plan();

}  // namespace kadans
