// The state hash of a run at even intervals. It shows when two runs begin to differ, without a record.
#pragma once

#include <string>
#include <vector>

#include "scenario/run.h"

namespace kadans {

struct HashMark {
  std::int64_t time_ns = 0;
  std::uint64_t hash = 0;
};

class HashTrail final : public RunObserver {
 public:
  explicit HashTrail(double every_s);  // > 0
  void between_ticks(const RunMark& mark) override;

  const std::vector<HashMark>& marks() const noexcept { return marks_; }
  std::vector<std::uint64_t> hashes() const;  // of the marks

 private:
  std::int64_t every_ns_, next_ns_;
  std::vector<HashMark> marks_;
};

// Writes one line for each mark, and reads the lines back. Damaged lines are left out.
std::string marks_text(const std::vector<HashMark>& marks);
std::vector<HashMark> marks_of(const std::string& text);

// When two trails begin to differ: "between 2 s and 3 s"; "" when they do not differ.
std::string where_parted(const std::vector<HashMark>& first, const std::vector<HashMark>& second);

}  // namespace kadans
