#include "hash_trail.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/json/fields.h"

namespace kadans {

HashTrail::HashTrail(double every_s)
    : every_ns_(std::max<std::int64_t>(std::llround(every_s * 1e9), 1)), next_ns_(every_ns_) {}

void HashTrail::between_ticks(const RunMark& mark) {
  if (mark.time_ns < next_ns_) return;
  marks_.push_back({mark.time_ns, mark.state_hash});
  next_ns_ = (mark.time_ns / every_ns_ + 1) * every_ns_;
}

std::vector<std::uint64_t> HashTrail::hashes() const {
  std::vector<std::uint64_t> hashes;
  for (const HashMark& mark : marks_) hashes.push_back(mark.hash);
  return hashes;
}

std::string marks_text(const std::vector<HashMark>& marks) {
  std::string text;
  for (const HashMark& mark : marks) text += std::to_string(mark.time_ns) + " " + hash_text(mark.hash) + "\n";
  return text;
}

std::vector<HashMark> marks_of(const std::string& text) {
  std::vector<HashMark> marks;
  std::istringstream lines(text);
  HashMark mark;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    if (fields >> mark.time_ns >> std::hex >> mark.hash) marks.push_back(mark);
  }
  return marks;
}

std::string where_parted(const std::vector<HashMark>& first, const std::vector<HashMark>& second) {
  const std::size_t both = std::min(first.size(), second.size());
  double same_s = 0;
  for (std::size_t i = 0; i < both; ++i) {
    const double time_s = static_cast<double>(first[i].time_ns) / 1e9;
    if (first[i].hash != second[i].hash)
      return "between " + number_text(same_s) + " s and " + number_text(time_s) + " s";
    same_s = time_s;
  }
  return {};
}

}  // namespace kadans
