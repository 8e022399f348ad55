
#include "merged_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <sqlite3.h>
#include <unistd.h>

#include "signal/input_file.h"
#include "signal/number_text.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

void refuse_mixed(const SweepResults& a, const SweepResults& b) {
  const std::string other = difference(a.manifest(), b.manifest());
  if (!other.empty()) refuse(b.folder(), "is of another sweep than " + a.folder().string() + ": " + other);
}

// A case that two folders hold must have come out the same.
void add(std::vector<CaseRow>& rows, std::vector<const SweepResults*>& from, CaseRow row, const SweepResults& part) {
  CaseRow& known = rows.at(row.index);
  if (from[row.index] == nullptr) {
    from[row.index] = &part;
    known = std::move(row);
    return;
  }
  if (known == row) return;
  refuse(part.folder(), "case " + std::to_string(row.index) + " came out different from that in " +
                            from[row.index]->folder().string() + " (state " + row.state_hash + " and " +
                            known.state_hash + "); again: " + row.repeat);
}

void append_number(std::string& line, double value) {
  line += ',';
  if (std::isfinite(value)) line += number_text(value);
}

}  // namespace

MergedSweep merge(const std::vector<SweepResults>& parts) {
  MergedSweep merged{.manifest = parts.at(0).manifest(), .rows = {}, .missing = {}, .quantities = {}};
  std::vector<CaseRow> rows(merged.manifest.cases);
  std::vector<const SweepResults*> from(rows.size());
  for (const SweepResults& part : parts) {
    refuse_mixed(parts.front(), part);
    for (CaseRow& row : part.rows()) {
      if (row.index >= rows.size())
        refuse(part.folder(), "case " + std::to_string(row.index) + " is none of this sweep");
      add(rows, from, std::move(row), part);
    }
  }
  std::set<std::string> quantities;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (from[i] == nullptr) {
      merged.missing.push_back(i);
      continue;
    }
    for (const QuantityValue& quantity : rows[i].quantities) quantities.insert(quantity.name);
    merged.rows.push_back(std::move(rows[i]));
  }
  merged.quantities.assign(quantities.begin(), quantities.end());
  return merged;
}

double value_of(const CaseRow& row, const std::string& name) {
  for (const auto* values : {&row.metrics, &row.quantities}) {
    const auto found = std::ranges::find(*values, name, &QuantityValue::name);
    if (found != values->end()) return found->value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> table_columns(const MergedSweep& sweep) {
  std::vector<std::string> columns{"case", "id", "scenario", "seed", "status", "failed", "simulated_s", "state_hash"};
  std::ranges::copy(sweep.quantities, std::back_inserter(columns));
  std::ranges::copy(sweep.manifest.metrics, std::back_inserter(columns));
  columns.emplace_back("repeat");
  return columns;
}

std::string csv_table(const MergedSweep& sweep) {
  std::string text = listed(table_columns(sweep), csv_field, ",");
  for (const CaseRow& row : sweep.rows) {
    text += "\r\n" + std::to_string(row.index) + ',' + row.id + ',' + csv_field(row.scenario) + ',' +
            std::to_string(row.seed) + ',' + name(row.status) + ',' + csv_field(row.failed);
    append_number(text, row.simulated_s);
    text += ',' + row.state_hash;
    for (const std::string& quantity : sweep.quantities) append_number(text, value_of(row, quantity));
    for (const std::string& metric : sweep.manifest.metrics) append_number(text, value_of(row, metric));
    text += ',' + csv_field(row.repeat);
  }
  return text + "\r\n";
}

// One writer, one pass in the order of the rows, no journal, unused bytes cleared, a fixed page size: the same rows
// give the same bytes. SQLite keeps no time in its files; the library's version is in them.

namespace {

namespace fs = std::filesystem;

constexpr std::size_t columns_max = 1900;  // SQLite takes 2,000

class Database {
 public:
  explicit Database(const fs::path& file) : file_(file) { check(sqlite3_open(file.c_str(), &database_)); }
  ~Database() { sqlite3_close(database_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void run(const std::string& sql) { check(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr)); }
  void check(int result) const {
    if (result == SQLITE_OK || result == SQLITE_DONE) return;
    refuse(file_, std::string("cannot be written: ") + sqlite3_errmsg(database_));
  }
  sqlite3* get() const noexcept { return database_; }

 private:
  fs::path file_;
  sqlite3* database_ = nullptr;
};

// An insertion into a table, a row at a time.
class Insertion {
 public:
  Insertion(Database& database, const std::string& table, std::size_t columns) : database_(database) {
    std::string sql = "INSERT INTO " + table + " VALUES (?";
    for (std::size_t i = 1; i < columns; ++i) sql += ",?";
    database.check(sqlite3_prepare_v2(database.get(), (sql + ")").c_str(), -1, &statement_, nullptr));
  }
  ~Insertion() { sqlite3_finalize(statement_); }
  Insertion(const Insertion&) = delete;
  Insertion& operator=(const Insertion&) = delete;

  void add(const std::string& text) {
    database_.check(
        sqlite3_bind_text(statement_, ++column_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
  }
  void add(std::uint64_t value) {
    database_.check(sqlite3_bind_int64(statement_, ++column_, static_cast<sqlite3_int64>(value)));
  }
  void add(double value) {
    database_.check(std::isfinite(value) ? sqlite3_bind_double(statement_, ++column_, value)
                                         : sqlite3_bind_null(statement_, ++column_));
  }
  void next() {
    database_.check(sqlite3_step(statement_));
    database_.check(sqlite3_reset(statement_));
    column_ = 0;
  }

 private:
  Database& database_;
  sqlite3_stmt* statement_ = nullptr;
  int column_ = 0;
};

void write_sweep(Database& database, const SweepManifest& manifest) {
  database.run("CREATE TABLE sweep (key TEXT PRIMARY KEY, value) WITHOUT ROWID");
  Insertion insertion(database, "sweep", 2);
  const auto add = [&](const char* key, const auto& value) {
    insertion.add(std::string(key));
    insertion.add(value);
    insertion.next();
  };
  add("cases", std::uint64_t{manifest.cases});
  add("doc", manifest.doc);
  add("name", manifest.sweep);
  add("plan", manifest.plan);
  add("sampling", manifest.sampling);
  add("seed", std::to_string(manifest.seed));
  add("version", manifest.version);
}

std::string cases_table(const MergedSweep& sweep) {
  std::string sql =
      "CREATE TABLE cases (\"case\" INTEGER PRIMARY KEY, id TEXT, scenario TEXT, seed INTEGER, status TEXT, failed "
      "TEXT, "
      "simulated_s REAL, state_hash TEXT";
  for (const auto* names : {&sweep.quantities, &sweep.manifest.metrics}) {
    for (const std::string& name : *names) sql += ", " + double_quoted(name) + " REAL";
  }
  return sql + ", repeat TEXT)";
}

void write_cases(Database& database, const MergedSweep& sweep) {
  database.run(cases_table(sweep));
  Insertion insertion(database, "cases", table_columns(sweep).size());
  for (const CaseRow& row : sweep.rows) {
    insertion.add(std::uint64_t{row.index});
    insertion.add(row.id);
    insertion.add(row.scenario);
    insertion.add(row.seed);
    insertion.add(std::string(name(row.status)));
    insertion.add(row.failed);
    insertion.add(row.simulated_s);
    insertion.add(row.state_hash);
    for (const std::string& quantity : sweep.quantities) insertion.add(value_of(row, quantity));
    for (const std::string& metric : sweep.manifest.metrics) insertion.add(value_of(row, metric));
    insertion.add(row.repeat);
    insertion.next();
  }
}

}  // namespace

void write_sqlite(const MergedSweep& sweep, const fs::path& file) {
  if (table_columns(sweep).size() > columns_max)
    refuse(file, "the sweep has too many quantities for SQLite; use --csv");
  const fs::path temporary = file.string() + "." + std::to_string(getpid()) + ".part";
  std::error_code ignored;
  fs::remove(temporary, ignored);
  try {
    Database database(temporary);
    database.run(
        "PRAGMA page_size = 4096; PRAGMA journal_mode = OFF; PRAGMA secure_delete = ON; PRAGMA encoding = 'UTF-8'; "
        "BEGIN");
    write_sweep(database, sweep.manifest);
    write_cases(database, sweep);
    database.run("COMMIT");
  } catch (...) {
    fs::remove(temporary, ignored);
    throw;
  }
  fs::rename(temporary, file);
}

}  // namespace kadans
