// A folder with the results of a sweep: sweep.json says which sweep it is, cases/ holds one file for each case. Files
// are written whole, so every file that exists is valid, and an interrupted sweep continues where it stopped. Several
// shards may share a folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "campaign/suite/run_outcome.h"
#include "sweep_case.h"

namespace kadans {

// The description of a sweep; it is the same for all its shards.
struct SweepManifest {
  std::string sweep, doc;  // its name
  std::string plan{};      // hash of its name and of all its cases
  std::string version;     // of the program
  std::string sampling;
  std::uint64_t seed = 1;
  std::size_t cases = 0;
  std::vector<std::string> metrics{};
  std::string first_try, time, worst;  // metrics, or ""
  std::string map_x, map_y, map_metric;
  double passed_min = 1;
};

SweepManifest manifest_of(const SweepPlan& plan, const std::vector<SweepCase>& cases, const std::string& version);

// The result of a case, without anything that would differ if it ran again (wall time).
struct CaseRow {
  std::size_t index = 0;
  std::string id;
  std::string scenario;
  std::uint64_t seed = 0;
  RunStatus status = RunStatus::crashed;
  std::string failed{};      // the names of the checks that failed, "; " between them
  std::string first_failed;  // the one of them that failed at the earliest time; "" when none failed
  std::string state_hash;    // "" when the run left none
  double simulated_s = 0;
  std::vector<QuantityValue> quantities;
  std::vector<MetricValue> metrics;
  std::string repeat;
  bool operator==(const CaseRow& other) const;  // bit for bit
};

class SweepResults {
 public:
  // Opens the folder for writing, and creates it if need be. Throws InputError when it holds another sweep.
  SweepResults(std::filesystem::path folder, const SweepManifest& manifest);
  // Opens an existing folder. Throws InputError when it holds no results.
  explicit SweepResults(std::filesystem::path folder);

  const std::filesystem::path& folder() const noexcept { return folder_; }
  const SweepManifest& manifest() const noexcept { return manifest_; }
  bool has(const SweepCase& one) const;
  void store(const SweepCase& one, const std::string& json) const;
  // Sorted by index. Throws InputError for a file that is no result of this sweep.
  std::vector<CaseRow> rows() const;

 private:
  std::filesystem::path file_of(const SweepCase& one) const;
  std::filesystem::path folder_;
  SweepManifest manifest_;
};

// The text of a case's result file, one line: {plan, case, id} and the report of the run without its evidence.
std::string case_json(const SweepManifest& manifest, const SweepCase& one, const RunOutcome& run);

// Where two manifests differ, for people: "seed 1 and 2"; "" when they are the same.
std::string difference(const SweepManifest& a, const SweepManifest& b);

}  // namespace kadans
