// Bounds the log lines of a behavior to lines_max in a second of the engine's clock, so that a script that logs in
// every tick floods neither the record nor the console. Further lines are dropped and counted.
#pragma once

#include <cstdint>

namespace kadans {

class LogBound {
 public:
  static constexpr std::uint32_t lines_max = 100;

  enum class Answer : std::uint8_t { say, warn, drop };  // warn: the first line that is dropped in this second
  Answer admit(std::int64_t now_ns) noexcept {
    if (now_ns - began_ns_ >= second_ns || now_ns < began_ns_) {
      began_ns_ = now_ns;
      said_ = 0;
    }
    if (said_ < lines_max) return ++said_, Answer::say;
    ++dropped_;
    return said_++ == lines_max ? Answer::warn : Answer::drop;
  }
  // Returns the lines dropped since the last call once their second is over, or with `at_once`; else 0.
  std::uint64_t take_dropped(std::int64_t now_ns, bool at_once) noexcept {
    if (dropped_ == 0 || (now_ns - began_ns_ < second_ns && !at_once)) return 0;
    const std::uint64_t count = dropped_;
    dropped_ = 0;
    return count;
  }

 private:
  static constexpr std::int64_t second_ns = 1'000'000'000;
  std::int64_t began_ns_ = 0;
  std::uint32_t said_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace kadans
