// Golden hashes: the state hashes with which the runs of a suite are expected to end. They stand in a file beside the
// folder of the scenarios (config/scenarios.golden.json). A change to the code that should not alter behavior is
// checked against them. A change that alters behavior on purpose renews the file, and the diff of the file shows which
// runs it touched. A hash for each second shows at what time a run begins to differ.
//
// The hashes hold for all processors of one architecture, and for one build of Bullet, which is named in the file.
// Another architecture rounds differently and needs a file of its own; another build of Bullet may, and then that is
// said.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "run_outcome.h"

namespace kadans {

struct GoldenRun {
  std::string scenario;
  std::uint64_t seed = 0;
  std::string hash;
  std::vector<std::string> each_s;  // the first eight digits
};

// The golden file of a folder of scenarios.
std::filesystem::path golden_file(const std::filesystem::path& folder);

class GoldenHashes {
 public:
  // Reads the file; a file that does not exist is an empty list. Throws InputError for a file that is no list of golden
  // hashes, or that belongs to another architecture. `bullet` names the build of Bullet that this program uses.
  explicit GoldenHashes(std::filesystem::path file, std::string bullet = {});

  const std::filesystem::path& file() const noexcept { return file_; }
  // Says where this run differs from the golden run, for a person: "its state parts from the golden run's between 2 s
  // and 3 s; ..."; "" when it does not differ.
  std::string difference(const RunOutcome& run) const;

  // Replaces the golden hashes of the runs that passed. With `all`, it also removes the golden runs that are not among
  // `runs`. Returns the changes, one line each.
  std::vector<std::string> take(const std::vector<RunOutcome>& runs, bool all);
  std::size_t size() const noexcept { return runs_.size(); }
  // Writes the file whole or not at all. Throws InputError when it cannot be written.
  void write() const;

 private:
  const GoldenRun* find(const std::string& scenario, std::uint64_t seed) const noexcept;

  std::filesystem::path file_;
  std::string bullet_, bullet_of_file_;
  std::vector<GoldenRun> runs_;  // by scenario and seed
};

}  // namespace kadans
