// What plays, as its host tells it after each behavior tick: decisions on another thread read it. Trivially copyable.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

namespace kadans {

struct PlayReport {
  static constexpr std::size_t behaviors_max = 8, name_max = 64, state_max = 128, why_max = 256;

  struct Playing {
    std::array<char, name_max> name{};    // cut off when it is longer
    std::array<char, state_max> state{};  // path of its innermost active state, the first of several
  };

  std::uint32_t given = 0;              // orders of the decisions so far, as the supervisor counts them
  std::uint32_t orders = 0;             // of them, taken by the behaviors
  std::uint32_t orders_refused = 0;     // of these
  std::array<char, why_max> refusal{};  // of the last one that was refused
  std::uint32_t taken_over = 0;         // how often something else was played, because nothing decided any more
  std::uint32_t phase = 0;              // as PlayStatus
  std::uint32_t not_done = 0;           // behaviors that ended otherwise than with done
  std::uint32_t count = 0;              // of those that play now, as far as they are listed
  std::array<Playing, behaviors_max> playing{};
};
static_assert(std::is_trivially_copyable_v<PlayReport>);

// For its texts: what is longer is cut off.
template <std::size_t room>
void put_text(std::array<char, room>& to, std::string_view text) noexcept {
  to.fill('\0');
  std::copy_n(text.begin(), std::min(text.size(), room - 1), to.begin());
}

// As bytes from outside. False: damaged.
[[nodiscard]] inline bool take_report(std::span<const std::byte> bytes, PlayReport& report) noexcept {
  if (bytes.size() != sizeof report) return false;
  std::memcpy(&report, bytes.data(), sizeof report);
  report.refusal.back() = '\0';
  for (PlayReport::Playing& one : report.playing) one.name.back() = one.state.back() = '\0';
  return report.count <= PlayReport::behaviors_max;
}

}  // namespace kadans
