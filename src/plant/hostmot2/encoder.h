// One encoder: its count of 16 bits continued to 64, and its velocity from the times at which the count changed.
//
// The board stamps each change with a clock of 16 bits (the time stamp counter). Between two changes that are seen in
// two ticks lie dS counts and dT of that clock, so v = dS / dT is exact to one tick of that clock, however slow the
// joint is. While no change comes, it cannot be faster than one count in the time since the last one. A single count
// back after one forth is an edge that trembles: 0.
//
// One owner, the control thread; nothing allocates or throws.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace kadans::hostmot2 {

class Encoder {
 public:
  // `stamps_per_s`: rate of the board's clock of time stamps.
  explicit Encoder(double stamps_per_s) noexcept : stamps_per_s_(stamps_per_s) {}

  // `word` holds stamp and count, `clock` is the clock when it was read, `passed_s` the time since the last reading by
  // another clock: when that is longer than the board's clock can count, no velocity is computed from it.
  void take(std::uint32_t word, std::uint32_t clock, double passed_s) noexcept {
    const auto count = static_cast<std::uint16_t>(word);
    const auto stamp = static_cast<std::uint16_t>(word >> 16U);
    const auto now16 = static_cast<std::uint16_t>(clock);
    if (!started_) {
      started_ = true;
      count_ = static_cast<std::int16_t>(count);
      last_count_ = count;
      last_clock_ = now16;
      changed_at_ = clock_ = 0;
      return;
    }
    const bool blind = !(passed_s * stamps_per_s_ < 60'000);
    clock_ += blind ? static_cast<std::int64_t>(std::clamp(passed_s, 0.0, 1e6) * stamps_per_s_)
                    : static_cast<std::uint16_t>(now16 - last_clock_);
    last_clock_ = now16;
    const auto steps = static_cast<std::int16_t>(static_cast<std::uint16_t>(count - last_count_));
    last_count_ = count;
    count_ += steps;
    if (steps == 0) {
      const double still_s = static_cast<double>(clock_ - changed_at_) / stamps_per_s_;
      const double most = still_s > 0 ? 1 / still_s : std::abs(counts_per_s_);
      counts_per_s_ = still_s > timeout_s ? 0 : std::clamp(counts_per_s_, -most, most);
      return;
    }
    const std::int64_t changed_at = clock_ - static_cast<std::uint16_t>(now16 - stamp);
    const auto took = static_cast<double>(changed_at - changed_at_);
    const bool trembles = std::abs(steps) == 1 && steps == -last_steps_;
    counts_per_s_ = blind || trembles || !(took > 0) ? 0 : steps / took * stamps_per_s_;
    changed_at_ = changed_at;
    last_steps_ = steps;
  }

  std::int64_t count() const noexcept { return count_; }
  double counts_per_s() const noexcept { return counts_per_s_; }
  // Where the count was, `latched` being its lower 16 bits, a short way ago.
  std::int64_t extended(std::uint16_t latched) const noexcept {
    return count_ + static_cast<std::int16_t>(static_cast<std::uint16_t>(latched - static_cast<std::uint16_t>(count_)));
  }

 private:
  static constexpr double timeout_s = 0.5;

  double stamps_per_s_;
  bool started_ = false;
  std::int64_t count_ = 0, clock_ = 0, changed_at_ = 0;
  std::uint16_t last_count_ = 0, last_clock_ = 0;
  int last_steps_ = 0;
  double counts_per_s_ = 0;
};

}  // namespace kadans::hostmot2
