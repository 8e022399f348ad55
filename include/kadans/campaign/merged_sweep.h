// The results of all shards of a sweep as one table: a row a case, by number. What is in it depends on the cases alone,
// not on how many shards made them, where, or in which order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kadans/campaign/sweep_results.h"

namespace kadans {

struct MergedSweep {
  SweepManifest manifest;
  std::vector<CaseRow> rows;            // by index
  std::vector<std::size_t> missing;     // cases without a result
  std::vector<std::string> quantities;  // that any row has, sorted
};

// Throws InputError when the folders hold different sweeps, or different results of one case.
MergedSweep merge(const std::vector<SweepResults>& parts);

// By name among a row's quantities and metrics; NaN when the row has none.
double value_of(const CaseRow& row, const std::string& name);

// case, id, scenario, seed, status, failed, simulated_s, state_hash, the quantities, the metrics, repeat.
std::vector<std::string> table_columns(const MergedSweep& sweep);

// RFC 4180, with a line of names; what is not finite is empty.
std::string csv_table(const MergedSweep& sweep);

// A database with the tables "sweep" (key, value) and "cases", the same bytes for the same rows. Replaces the file when
// it is complete. Throws InputError when it cannot be written.
void write_sqlite(const MergedSweep& sweep, const std::filesystem::path& file);

}  // namespace kadans
