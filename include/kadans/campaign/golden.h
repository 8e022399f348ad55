// The state hashes that the runs of a suite are known to end with: a file in the tree, beside the folder of its
// scenarios (config/scenarios.golden.json). A change that should make no difference is shown to make none; one that
// makes a difference renews the file, and the diff of the tree tells which runs it touched. Hashes of each second tell
// where.
//
// The numbers are those of one architecture, whatever the processor: another rounds otherwise and has to have its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kadans/campaign/run_outcome.h"

namespace kadans {

struct GoldenRun {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string hash;
  std::vector<std::string> each_s;  // the first eight digits
};

// The file that goes with a folder of scenarios.
std::filesystem::path golden_file(const std::filesystem::path& folder);

class GoldenHashes {
 public:
  // Reads what is there; nothing is an empty list. Throws InputError for a file that is none of these, or of another
  // machine.
  explicit GoldenHashes(std::filesystem::path file);

  const std::filesystem::path& file() const noexcept { return file_; }
  // Why this run is not the golden one, "" when it is: "state parts from the golden run between 2 s and 3 s".
  std::string difference(const RunOutcome& run) const;

  // Takes the runs that passed in place of what was known of them; with `all`, forgets what was not run. Gives what
  // that changes, a line each.
  std::vector<std::string> take(const std::vector<RunOutcome>& runs, bool all);
  std::size_t size() const noexcept { return runs_.size(); }
  // In one piece, or not at all. Throws InputError when it cannot be written.
  void write() const;

 private:
  const GoldenRun* find(const std::string& scenario, std::uint64_t seed) const noexcept;

  std::filesystem::path file_;
  std::vector<GoldenRun> runs_;  // by scenario and seed
};

}  // namespace kadans
