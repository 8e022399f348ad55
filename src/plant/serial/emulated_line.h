// What an emulated device says on a serial line, in time that the caller passes, and what befalls the line's bytes, by
// seeded chance.
//
// One owner, one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <string_view>

#include "kadans/signal/random.h"

namespace kadans {

class EmulatedLine {
 public:
  struct Faults {  // shares of the bytes
    double corrupt = 0, lost = 0;
  };
  Faults faults;

  // Takes the bytes that the host has now.
  std::size_t take(std::span<std::uint8_t> into, std::int64_t now_ns) {
    std::size_t count = 0;
    while (count < into.size() && !under_way_.empty() && under_way_.front().due_ns <= now_ns) {
      into[count++] = under_way_.front().byte;
      under_way_.pop_front();
    }
    return count;
  }
  void drop_answers() noexcept { under_way_.clear(); }

 protected:
  EmulatedLine(std::uint64_t seed, std::string_view name) : random_(seed, name) {}
  ~EmulatedLine() = default;

  // When the host has the next byte; INT64_MAX: none is on the way.
  std::int64_t next_byte_ns() const noexcept {
    return under_way_.empty() ? std::numeric_limits<std::int64_t>::max() : under_way_.front().due_ns;
  }
  // Whether the byte is lost; else it may be another one now.
  bool disturbed(std::uint8_t& byte) {
    if (faults.lost > 0 && random_.uniform() < faults.lost) return true;
    if (faults.corrupt > 0 && random_.uniform() < faults.corrupt) byte = static_cast<std::uint8_t>(random_.next());
    return false;
  }
  void send(std::span<const std::uint8_t> bytes, std::int64_t due_ns) {
    for (std::uint8_t byte : bytes) {
      if (!disturbed(byte)) under_way_.push_back({due_ns, byte});
    }
  }

 private:
  struct Arrival {
    std::int64_t due_ns;
    std::uint8_t byte;
  };
  RandomStream random_;
  std::deque<Arrival> under_way_;
};

}  // namespace kadans
