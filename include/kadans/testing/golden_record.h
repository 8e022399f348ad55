// Compares signals with a golden record: signals that somebody looked at and found right, kept in a CSV file beside the
// test.
//
//   GoldenRecord record({"position_rad", "effort_Nm"});
//   for (...) record.add({bench.position_rad(), bench.torque_Nm()});
//   CHECK(record.compare_to(KADANS_SOURCE_DIR "/tests/control/data/knee.csv", {.absolute = 1e-6}));
//
// With KADANS_UPDATE_GOLDEN=1 in the environment the file is written instead, and the comparison passes: look at the
// difference before you commit it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <vector>

namespace kadans::testing {

// A value fits when it differs by at most absolute + relative |golden|. NaN fits NaN.
struct GoldenTolerance {
  double absolute = 1e-9, relative = 1e-6;
};

struct GoldenResult {
  bool same = false;
  std::string message;                // the first difference, or why the file cannot be used
  std::vector<double> golden, found;  // the signal that differs, for a plot
  explicit operator bool() const noexcept { return same; }
};
std::ostream& operator<<(std::ostream& out, const GoldenResult& result);

class GoldenRecord {
 public:
  explicit GoldenRecord(std::vector<std::string> columns);

  // Throws std::invalid_argument unless there is one value per column.
  void add(std::initializer_list<double> row);
  // Throws std::runtime_error when the file cannot be written.
  GoldenResult compare_to(const std::filesystem::path& file, const GoldenTolerance& tolerance = {}) const;

 private:
  void write(const std::filesystem::path& file) const;

  std::vector<std::string> columns_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace kadans::testing
