// Random numbers that repeat. Every use has a named stream of its own, so that a new stream disturbs no other. All
// streams of a run come from the run's one seed. The same seed gives the same numbers everywhere: one normal number in
// seventy needs an exponential or a logarithm, and for these the program has its own functions
// (src/signal/portable_math.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace kadans {

// xoshiro256** (Blackman and Vigna, 2018), seeded by splitmix64 from the run's seed and the stream's name.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name) noexcept;
  // Begins at a given state of the generator; not all words may be 0.
  explicit RandomStream(const std::array<std::uint64_t, 4>& state) noexcept : state_(state) {}

  std::uint64_t next() noexcept;
  double uniform() noexcept;                         // [0, 1)
  double uniform(double low, double high) noexcept;  // [low, high], high only by rounding
  double normal() noexcept;  // mean 0, standard deviation 1 (ziggurat, Marsaglia and Tsang 2000)

 private:
  double tail() noexcept;

  std::array<std::uint64_t, 4> state_;
};

}  // namespace kadans
