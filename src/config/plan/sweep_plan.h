// A sweep: scenarios run many times over a sample of their quantities, in one JSON file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "experiment_config.h"

namespace kadans {

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

}  // namespace kadans
