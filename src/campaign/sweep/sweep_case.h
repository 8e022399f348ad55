// The cases of a sweep: which run each case is, and the name under which its result is stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/plan/experiment_plans.h"
#include "sampling.h"

namespace kadans {

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

// One part of a sweep, for one of several processes or machines that share the work.

// Holds every `count`-th case, beginning with case `index`.
struct Shard {
  std::size_t index = 0, count = 1;
  bool holds(std::size_t number) const noexcept { return number % count == index; }
  bool whole() const noexcept { return count == 1; }
};

// Reads "0/4" .. "3/4". Throws InputError.
Shard parse_shard(const std::string& text);

// The shard of this task in a Slurm array, from SLURM_ARRAY_TASK_ID, _COUNT, _MIN and _STEP; nullopt outside an array.
// Throws InputError when the array is not a range.
std::optional<Shard> slurm_shard();

}  // namespace kadans
