// Random numbers that repeat. Every use has a stream of its own, named, so that adding one disturbs no other; all
// streams of a run come from the run's one seed. The same seed gives the same numbers everywhere; one normal number in
// seventy asks for an exponential or a logarithm, which the program has of its own (src/signal/portable_math.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace kadans {

// xoshiro256** (Blackman and Vigna, 2018), seeded by splitmix64 from the run's seed and the stream's name.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name) noexcept;
  // The generator at a state of its own, as published; not all words 0.
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
