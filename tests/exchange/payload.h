// What the stress tests send: a number, words that follow from it, and a checksum that a torn value cannot keep.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>

namespace kadans::test {

struct Payload {
  std::uint64_t sequence = 0;
  std::array<std::uint64_t, 62> words{};
  std::uint64_t checksum = 0;
};
static_assert(sizeof(Payload) == 512);

inline std::uint64_t checksum(const Payload& payload) noexcept {
  std::uint64_t sum = payload.sequence;
  for (const std::uint64_t word : payload.words) sum = sum * 31 + word;
  return sum;
}

inline Payload make_payload(std::uint64_t sequence) noexcept {
  Payload payload;
  payload.sequence = sequence;
  std::uint64_t word = sequence;
  for (std::uint64_t& w : payload.words) w = word = word * 0x9e3779b97f4a7c15U + 1;
  payload.checksum = checksum(payload);
  return payload;
}

inline bool is_whole(const Payload& payload) noexcept {
  return payload.words == make_payload(payload.sequence).words && payload.checksum == checksum(payload);
}

// How often a stress test repeats: a moment by default, a soak of about 10^8 with KADANS_SOAK=1 in the environment.
inline std::uint64_t stress_count(std::uint64_t normal) {
  const char* soak = std::getenv("KADANS_SOAK");
  return soak != nullptr && *soak == '1' ? 100'000'000 : normal;
}

}  // namespace kadans::test
