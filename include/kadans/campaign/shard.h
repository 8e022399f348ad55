// A part of many runs: one of several processes, or machines, takes every n-th of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace kadans {

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
