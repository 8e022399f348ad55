#include "kadans/testing/golden_record.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "signal/number_text.h"
#include "telemetry/plot.h"

namespace kadans::testing {
namespace {

constexpr const char* renewal = "run the test with KADANS_UPDATE_GOLDEN=1 to write it, then look at it";

bool update_wanted() {
  const char* wanted = std::getenv("KADANS_UPDATE_GOLDEN");  // NOLINT(concurrency-mt-unsafe): tests set no environment
  return wanted != nullptr && std::string(wanted) == "1";
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

bool fits(double golden, double found, const GoldenTolerance& tolerance) {
  if (std::isnan(golden) || std::isnan(found)) return std::isnan(golden) && std::isnan(found);
  if (std::isinf(golden) || std::isinf(found)) return golden == found;
  return std::abs(found - golden) <= tolerance.absolute + tolerance.relative * std::abs(golden);
}

// False unless the whole cell is a number.
bool number(const std::string& cell, double& value) {
  char* end = nullptr;
  value = std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == '\0';
}

}  // namespace

GoldenRecord::GoldenRecord(std::vector<std::string> columns) : columns_(std::move(columns)) {
  if (columns_.empty()) throw std::invalid_argument("a golden record needs a column");
}

void GoldenRecord::add(std::initializer_list<double> row) {
  if (row.size() != columns_.size()) {
    throw std::invalid_argument("a golden record of " + std::to_string(columns_.size()) + " columns was given " +
                                std::to_string(row.size()) + " values");
  }
  rows_.emplace_back(row);
}

void GoldenRecord::write(const std::filesystem::path& file) const {
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  std::ofstream out(file);
  for (std::size_t i = 0; i < columns_.size(); ++i) out << (i > 0 ? "," : "") << columns_[i];
  out << '\n';
  for (const std::vector<double>& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) out << (i > 0 ? "," : "") << printed("%.9g", row[i]);
    out << '\n';
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

GoldenResult GoldenRecord::compare_to(const std::filesystem::path& file, const GoldenTolerance& tolerance) const {
  if (update_wanted()) {
    write(file);
    return {true, "written", {}, {}};
  }
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) return {false, "there is no " + file.string() + ": " + renewal, {}, {}};
  if (split(line) != columns_) return {false, file.string() + " has other columns: " + line, {}, {}};
  GoldenResult result{true, "as golden", {}, {}};
  std::vector<std::vector<double>> golden(columns_.size());
  std::size_t differs = columns_.size(), rows = 0;
  for (; std::getline(in, line); ++rows) {
    const std::vector<std::string> cells = split(line);
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      double value = 0;
      if (cells.size() != columns_.size() || !number(cells[column], value)) {
        return {false, file.string() + ":" + std::to_string(rows + 2) + " is no row of numbers: " + line, {}, {}};
      }
      golden[column].push_back(value);
      if (!result.same || rows >= rows_.size() || fits(value, rows_[rows][column], tolerance)) continue;
      differs = column;
      const double found = rows_[rows][column];
      result = {false, columns_[column] + printed(" in row %zu: %.9g, golden is %.9g", rows, found, value), {}, {}};
    }
  }
  if (differs < columns_.size()) {
    result.golden = golden[differs];
    for (const std::vector<double>& row : rows_) result.found.push_back(row[differs]);
  } else if (rows != rows_.size()) {
    result = {false, std::to_string(rows_.size()) + " rows, golden are " + std::to_string(rows), {}, {}};
  }
  return result;
}

std::ostream& operator<<(std::ostream& out, const GoldenResult& result) {
  out << result.message << '\n';
  if (result.golden.empty()) return out;
  const auto rows = static_cast<double>(result.golden.size());
  return out << plot_text({.x = {.name = "rows", .range = {0, rows}},
                           .lines = {plot_line("golden", result.golden, 0, rows),
                                     plot_line("found", result.found, 0, static_cast<double>(result.found.size()))}},
                          {.rows = 6});
}

}  // namespace kadans::testing
