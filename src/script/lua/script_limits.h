// What one playing behavior may use. Instructions are those of the Lua interpreter, counted in steps of a thousand; a
// library call is charged in proportion to its work. Time is that of the wall clock, without the time in which the
// machine ran other threads.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kadans {

struct ScriptLimits {
  std::uint64_t tick_instructions = 200'000;
  std::uint64_t load_instructions = 5'000'000;
  std::uint64_t reload_instructions = 1'000'000;  // fewer, because all behaviors stand still meanwhile
  std::int64_t tick_wall_ns = 0;                  // 0: no limit; so on a virtual clock, where a run repeats bit for bit
  std::int64_t load_wall_ns = 0;                  // the same for loading or reloading a file
  std::size_t memory_bytes = std::size_t{4} << 20;
  std::size_t block_bytes = std::size_t{576} << 10;  // of one string or one table's array; the deepest stack fits
};

}  // namespace kadans
