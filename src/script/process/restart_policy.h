// Decides when a process that died is started again: the first time at once, then after growing delays, and no more
// when it dies too often in a row. A process that has answered enough ticks begins a new row. Times are of the engine's
// clock.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace kadans {

class RestartPolicy {
 public:
  struct Settings {
    std::uint32_t deaths_max = 8;         // deaths in a row after which it stays down
    std::uint32_t proved_ticks = 10;      // answered ticks after which the next death is the first of a row
    std::int64_t delay_ns = 100'000'000;  // before the second restart of a row; then twice as long each time
    std::int64_t delay_max_ns = 2'000'000'000;
  };
  explicit RestartPolicy(const Settings& settings) noexcept : settings_(settings) {}

  void answered() noexcept {
    if (++ticks_ == settings_.proved_ticks) in_a_row_ = 0;
  }
  // Returns when to start the next process; nullopt: it stays down.
  std::optional<std::int64_t> died(std::int64_t now_ns) noexcept {
    ticks_ = 0;
    ++deaths_;
    if (++in_a_row_ >= settings_.deaths_max) return std::nullopt;
    std::int64_t delay_ns = in_a_row_ > 1 ? settings_.delay_ns : 0;
    for (std::uint32_t i = 2; i < in_a_row_ && delay_ns < settings_.delay_max_ns; ++i) delay_ns *= 2;
    return now_ns + std::min(delay_ns, settings_.delay_max_ns);
  }
  std::uint32_t in_a_row() const noexcept { return in_a_row_; }
  std::uint64_t deaths() const noexcept { return deaths_; }

 private:
  Settings settings_;
  std::uint32_t in_a_row_ = 0, ticks_ = 0;
  std::uint64_t deaths_ = 0;
};

}  // namespace kadans
