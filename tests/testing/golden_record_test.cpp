#include "kadans/testing/golden_record.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <doctest/doctest.h>
#include <unistd.h>

using kadans::testing::GoldenRecord;

namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path root = fs::path(KADANS_BINARY_DIR) / "tests" / "folders" / std::to_string(getpid());
  fs::path file = root / "golden" / "record.csv";
  Folder() { fs::remove_all(root); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(root, ignored);
    unsetenv("KADANS_UPDATE_GOLDEN");  // NOLINT(concurrency-mt-unsafe): one thread
  }
  void update(bool wanted) const {
    setenv("KADANS_UPDATE_GOLDEN", wanted ? "1" : "0", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  }
  void write(const char* text) const { std::ofstream(file) << text; }
};

GoldenRecord record(double at_70) {
  GoldenRecord made({"time_s", "position_rad"});
  for (int i = 0; i < 100; ++i) made.add({0.001 * i, i == 70 ? at_70 : std::sin(0.1 * i)});
  return made;
}

}  // namespace

TEST_CASE("A record is written on demand, and then the same record is golden") {
  const Folder folder;
  folder.update(false);
  CHECK_FALSE(record(0.5).compare_to(folder.file));
  CHECK_FALSE(fs::exists(folder.file));
  folder.update(true);
  CHECK(record(0.5).compare_to(folder.file));
  folder.update(false);
  CHECK(record(0.5).compare_to(folder.file));
  CHECK(record(0.5 + 9e-7).compare_to(folder.file, {.absolute = 1e-6, .relative = 0}));
}

TEST_CASE("A value beyond the tolerance is named with its column and row, and both signals are drawn") {
  const Folder folder;
  folder.update(true);
  CHECK(record(0.5).compare_to(folder.file));
  folder.update(false);
  const auto result = record(0.75).compare_to(folder.file, {.absolute = 0.2});
  CHECK_FALSE(result);
  CHECK(result.message == "position_rad in row 70: 0.75, golden is 0.5");
  CHECK(result.golden.size() == 100);
  CHECK(result.found[70] == 0.75);
  std::ostringstream out;
  out << result;
  for (const char* part : {"golden", "found", "rows"}) CHECK(out.str().find(part) != std::string::npos);
  CHECK_FALSE(record(std::numeric_limits<double>::quiet_NaN()).compare_to(folder.file));
}

TEST_CASE("Another length, other columns and a broken file are no match") {
  const Folder folder;
  folder.update(true);
  CHECK(record(0.5).compare_to(folder.file));
  folder.update(false);
  GoldenRecord longer = record(0.5);
  longer.add({0.1, 0});
  CHECK(longer.compare_to(folder.file).message == "101 rows, golden are 100");
  CHECK_FALSE(GoldenRecord({"time_s", "velocity_rad_s"}).compare_to(folder.file));
  folder.write("time_s,position_rad\n0,zero\n");
  CHECK(record(0.5).compare_to(folder.file).message.find(":2 is no row of numbers: 0,zero") != std::string::npos);
  CHECK_THROWS_AS(longer.add({1}), std::invalid_argument);
}
