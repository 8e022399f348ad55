// What became of the datagrams that carry numbers: which never came, came twice, or came behind a newer one.
#pragma once

#include <cstdint>
#include <vector>

#include "kadans/plant/plant.h"

namespace kadans {

struct DatagramCounts {
  std::uint32_t sent = 0;
  std::uint32_t unsent = 0;     // the system did not accept them
  std::uint32_t received = 0;   // in order or not, without duplicates
  std::uint32_t lost = 0;       // never came
  std::uint32_t reordered = 0;  // came after a newer one: not used
  std::uint32_t duplicates = 0;
  std::uint32_t late = 0;     // the newest, but too old to count as new
  std::uint32_t refused = 0;  // garbage, another robot's, another session's, a stranger's
};

inline std::vector<PlantCount> counts_of(const DatagramCounts& s) {
  return {{"sent", s.sent},           {"unsent", s.unsent},         {"received", s.received}, {"lost", s.lost},
          {"reordered", s.reordered}, {"duplicates", s.duplicates}, {"late", s.late},         {"refused", s.refused}};
}

// Sorts the datagrams of the other side by their sequence numbers: the newest is used, the others are counted.
//
// A number that is skipped counts as lost, until it still comes while it is one of the last 64. A number that comes
// twice is a duplicate. The counts are plain numbers, owned by the thread that receives; others read them once it has
// ended.
class Arrivals {
 public:
  // Whether the datagram is newer than all before; a sequence counts from 1.
  bool is_newest(std::uint64_t sequence, DatagramCounts& statistics) noexcept {
    if (sequence > newest_) {
      const std::uint64_t step = sequence - newest_;
      seen_ = step < 64 ? seen_ << step : 0;
      seen_ |= 1U;
      newest_ = sequence;
      statistics.lost += static_cast<std::uint32_t>(step - 1);
      ++statistics.received;
      return true;
    }
    const std::uint64_t behind = newest_ - sequence;
    const std::uint64_t bit = behind < 64 ? std::uint64_t{1} << behind : 0;
    if (bit == 0 || (seen_ & bit) != 0) {
      ++statistics.duplicates;
      return false;
    }
    seen_ |= bit;
    if (statistics.lost > 0) --statistics.lost;
    ++statistics.received;
    ++statistics.reordered;
    return false;
  }

 private:
  std::uint64_t newest_ = 0, seen_ = 0;
};

}  // namespace kadans
