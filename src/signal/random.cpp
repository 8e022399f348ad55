#include "kadans/signal/random.h"

#include <bit>
#include <cmath>

namespace kadans {
namespace {

std::uint64_t splitmix64(std::uint64_t& state) noexcept {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15U);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

std::uint64_t fnv1a(std::string_view text) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

// The bell curve exp(-x^2 / 2) covered by layers of one area, the widest below: layer i is edges[i] wide and reaches
// from the curve's height there to that at edges[i + 1]. The lowest holds the tail too and is as wide as it has to be
// for that. Edge and area are those of Marsaglia and Tsang for 128 layers.
constexpr std::size_t layers = 128;
constexpr double edge = 3.442619855899, area = 9.91256303526217e-3;

double bell(double x) noexcept { return std::exp(-0.5 * x * x); }

std::array<double, layers + 1> find_edges() noexcept {
  std::array<double, layers + 1> found{area / bell(edge), edge};
  for (std::size_t i = 2; i < layers; ++i) {
    found[i] = std::sqrt(-2 * std::log(bell(found[i - 1]) + area / found[i - 1]));
  }
  return found;
}

const std::array<double, layers + 1> edges = find_edges();

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) noexcept {
  std::uint64_t state = seed;
  state = splitmix64(state) ^ fnv1a(name);
  for (std::uint64_t& word : state_) word = splitmix64(state);
}

std::uint64_t RandomStream::next() noexcept {
  const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
  const std::uint64_t shifted = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double RandomStream::uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double RandomStream::uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }

// A layer a number at random: nearly all of its width lies below the curve. What is left is asked of the curve itself;
// below the lowest layer's edge there is the tail.
double RandomStream::normal() noexcept {
  while (true) {
    const std::uint64_t bits = next();
    const std::size_t layer = bits % layers;
    const double x = static_cast<double>(static_cast<std::int64_t>(bits) >> 11) * 0x1.0p-52 * edges[layer];
    if (std::fabs(x) < edges[layer + 1]) return x;
    if (layer == 0) return std::copysign(tail(), x);
    const double below = bell(edges[layer]), above = bell(edges[layer + 1]);
    if (below + uniform() * (above - below) < bell(x)) return x;
  }
}

// Of numbers beyond the edge (Marsaglia 1964).
double RandomStream::tail() noexcept {
  while (true) {
    const double beyond = -std::log(1 - uniform()) / edge, height = -std::log(1 - uniform());
    if (2 * height > beyond * beyond) return edge + beyond;
  }
}

}  // namespace kadans
