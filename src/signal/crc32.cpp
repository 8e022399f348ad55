#include "crc32.h"

#include <array>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace kadans {
namespace {

// "Slicing by eight" (Kounavis and Berry, 2008): tables[k][b] is the CRC of byte b followed by k zero bytes, so eight
// bytes are folded in with eight look-ups that do not wait for each other.
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables make_tables() noexcept {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8U) ^ tables[0][before & 0xffU];
    }
  }
  return tables;
}

constexpr Tables tables = make_tables();

constexpr std::uint32_t word(const std::byte* bytes) noexcept {
  return std::to_integer<std::uint32_t>(bytes[0]) | std::to_integer<std::uint32_t>(bytes[1]) << 8U |
         std::to_integer<std::uint32_t>(bytes[2]) << 16U | std::to_integer<std::uint32_t>(bytes[3]) << 24U;
}

#if defined(__x86_64__) || defined(__i386__)
// Folding by carry-less multiplication (Gopal, Ozturk, Guilford and others, "Fast CRC Computation for Generic
// Polynomials Using PCLMULQDQ Instruction", 2009; the constants of the reflected polynomial are the paper's). 64 bytes
// a step in four lanes, then 16 in one, then 128 bits are reduced to 32.
constexpr std::size_t folded_min = 64;

struct Lane {
  __m128i bits;
};

__attribute__((target("pclmul,sse4.1"))) inline __m128i folded(__m128i lane, __m128i constants,
                                                               const std::byte* next) noexcept {
  const __m128i more = _mm_loadu_si128(reinterpret_cast<const __m128i*>(next));
  return _mm_xor_si128(
      _mm_xor_si128(_mm_clmulepi64_si128(lane, constants, 0x00), _mm_clmulepi64_si128(lane, constants, 0x11)), more);
}

// Of whole 16 bytes, at least folded_min.
__attribute__((target("pclmul,sse4.1"))) std::uint32_t fold(std::uint32_t crc, const std::byte* at,
                                                            std::size_t left) noexcept {
  const __m128i four = _mm_set_epi64x(0x01c6e41596, 0x0154442bd4), one = _mm_set_epi64x(0x00ccaa009e, 0x01751997d0);
  std::array<Lane, 4> lanes{};
  for (Lane& lane : lanes) {
    lane.bits = _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
    at += sizeof lane;
  }
  lanes[0].bits = _mm_xor_si128(lanes[0].bits, _mm_cvtsi32_si128(static_cast<int>(crc)));
  for (left -= folded_min; left >= folded_min; left -= folded_min) {
    for (Lane& lane : lanes) {
      lane.bits = folded(lane.bits, four, at);
      at += sizeof lane;
    }
  }
  __m128i all = lanes[0].bits;
  for (std::size_t i = 1; i < lanes.size(); ++i) {
    all = _mm_xor_si128(_mm_xor_si128(_mm_clmulepi64_si128(all, one, 0x00), _mm_clmulepi64_si128(all, one, 0x11)),
                        lanes[i].bits);
  }
  for (; left >= sizeof all; left -= sizeof all, at += sizeof all) all = folded(all, one, at);
  const __m128i low32 = _mm_setr_epi32(-1, 0, -1, 0);
  all = _mm_xor_si128(_mm_srli_si128(all, 8), _mm_clmulepi64_si128(all, one, 0x10));
  all = _mm_xor_si128(_mm_srli_si128(all, 4),
                      _mm_clmulepi64_si128(_mm_and_si128(all, low32), _mm_set_epi64x(0, 0x0163cd6124), 0x00));
  const __m128i polynomial = _mm_set_epi64x(0x01f7011641, 0x01db710641);
  __m128i quotient = _mm_clmulepi64_si128(_mm_and_si128(all, low32), polynomial, 0x10);
  quotient = _mm_clmulepi64_si128(_mm_and_si128(quotient, low32), polynomial, 0x00);
  return static_cast<std::uint32_t>(_mm_extract_epi32(_mm_xor_si128(all, quotient), 1));
}

const bool folds = __builtin_cpu_supports("pclmul") != 0 && __builtin_cpu_supports("sse4.1") != 0;
#endif

}  // namespace

void Crc32::add(std::span<const std::byte> bytes) noexcept {
  std::uint32_t crc = state_;
  const std::byte* at = bytes.data();
  std::size_t left = bytes.size();
#if defined(__x86_64__) || defined(__i386__)
  if (folds && left >= folded_min) {
    const std::size_t whole = left / 16 * 16;
    crc = fold(crc, at, whole);
    at += whole;
    left -= whole;
  }
#endif
  for (; left >= 8; at += 8, left -= 8) {
    const std::uint32_t low = crc ^ word(at);
    const std::uint32_t high = word(at + 4);
    crc = tables[7][low & 0xffU] ^ tables[6][(low >> 8U) & 0xffU] ^ tables[5][(low >> 16U) & 0xffU] ^
          tables[4][low >> 24U] ^ tables[3][high & 0xffU] ^ tables[2][(high >> 8U) & 0xffU] ^
          tables[1][(high >> 16U) & 0xffU] ^ tables[0][high >> 24U];
  }
  for (; left > 0; ++at, --left) crc = (crc >> 8U) ^ tables[0][(crc ^ std::to_integer<std::uint32_t>(*at)) & 0xffU];
  state_ = crc;
}

}  // namespace kadans
