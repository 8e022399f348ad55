// The results of all shards of a sweep as one table: one row for each case, sorted by number. The table depends on the
// cases alone, not on the number of shards, their machines or their order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sweep_results.h"

namespace kadans {

struct MergedSweep {
  SweepManifest manifest;
  std::vector<CaseRow> rows;            // by index
  std::vector<std::size_t> missing;     // cases without a result
  std::vector<std::string> quantities;  // of all rows together, sorted
};

// Throws InputError when the folders hold different sweeps, or different results of one case.
MergedSweep merge(const std::vector<SweepResults>& parts);

// The value of the quantity or metric with this name; NaN when the row has none.
double value_of(const CaseRow& row, const std::string& name);

// The columns: case, id, scenario, seed, status, failed, simulated_s, state_hash, the quantities, the metrics, repeat.
std::vector<std::string> table_columns(const MergedSweep& sweep);

// CSV by RFC 4180 with a header line; a value that is not finite is an empty field.
std::string csv_table(const MergedSweep& sweep);

// Writes an SQLite database with the tables "sweep" (key, value) and "cases". The same rows give the same bytes. The
// old file is replaced when the new one is complete. Throws InputError when it cannot be written.
void write_sqlite(const MergedSweep& sweep, const std::filesystem::path& file);

}  // namespace kadans
