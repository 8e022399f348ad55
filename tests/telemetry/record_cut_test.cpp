// A stretch of a record is a record.
#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "telemetry/reading/record_comparison.h"
#include "telemetry/reading/record_export.h"
#include "written_record.h"

namespace record_cut_test {

using namespace kadans;

namespace {

constexpr std::int64_t ms = 1'000'000;

std::vector<std::string> lines_of(const std::string& file, TimeSpan span = {}) {
  JsonLines lines(file, {}, span);
  std::vector<std::string> all;
  for (std::string line; lines.next(line);) all.push_back(line);
  REQUIRE_MESSAGE(lines.reader().complete(), lines.reader().problem());
  return all;
}

}  // namespace

TEST_CASE("a cut holds the messages of its time as they were, with facts and attachments, and ends well") {
  WrittenRecord record;
  write_knee(record);
  const RecordOutline whole = record.outline();
  const ScratchFile file;
  const CutRecord made = cut_record(whole, {.span = {30 * ms, 55 * ms}, .signals = {}}, file.path());
  std::vector<std::string> expected = lines_of(whole.file, {30 * ms, 55 * ms});
  std::vector<std::string> got = lines_of(file.path());
  // What holds from the beginning on comes first.
  REQUIRE(got.size() == expected.size() + 3);
  CHECK(got[0] == R"({"time_s":0.029,"topic":"/knee","tick":29,"knee.angle_rad":0.029,"knee.torque_Nm":-29})");
  CHECK(got[1] == R"({"time_s":0.02,"topic":"/slow","tick":20,"slow.temperature_C":20.2})");
  CHECK(got[2] == R"({"time_s":0.03,"topic":"/description","robot":{"name":"leg"}})");
  got.erase(got.begin(), got.begin() + 3);
  CHECK(got == expected);
  CHECK(made.messages == expected.size() + 3);
  const RecordOutline cut = outline_of(file.path());
  CHECK(cut.complete);
  CHECK(cut.robot() == "leg");
  CHECK(cut.fact("run", "scenario") == "knee.json");
  CHECK(cut.fact("cut", "from_s") == "0.03");
  CHECK(cut.file_bytes == made.file_bytes);
}

TEST_CASE("a cut of some signals holds these alone, under their names and units, in messages that say so") {
  WrittenRecord record(Precision::single);
  write_knee(record);
  const ScratchFile file;
  CHECK(cut_record(record.outline(), {.span = {}, .signals = {"knee.torque_Nm"}}, file.path()).signals == 1);
  const RecordOutline cut = outline_of(file.path());
  CHECK(cut.signal_names() == std::vector<std::string>{"knee.torque_Nm"});
  RecordRows rows(file.path());
  std::uint32_t seen = 0;
  while (rows.next()) {
    if (rows.values().empty()) continue;
    CHECK(rows.topic().signals[0].unit == "Nm");
    CHECK(rows.precision() == Precision::single);
    REQUIRE(rows.values().size() == 1);
    CHECK(rows.values()[0] == -1.0 * rows.tick());
    ++seen;
  }
  CHECK(seen == 100);
  const McapReader& reader = rows.reader();
  CHECK(reader.schemas().at(reader.channels().begin()->second.schema).text.find("angle") == std::string::npos);
}

TEST_CASE("a signal that stands still when the cut begins keeps the row that holds") {
  WrittenRecord record;
  const std::uint16_t still = record.rows({"still.value|"}), never = record.rows({"never.value|"}),
                      knee = record.rows({"knee.angle_rad|rad"});
  record.row(never, 0, {3});
  for (std::uint32_t tick = 0; tick < 60; ++tick) {
    if (tick == 0 || tick == 40) record.row(still, tick, {tick == 0 ? 7.0 : 8.0});
    record.row(knee, tick, {1.0 * tick});
  }
  const ScratchFile file;
  (void)cut_record(record.outline(), {.span = {30 * ms, 50 * ms}, .signals = {}}, file.path());
  const RecordOutline cut = outline_of(file.path());
  CsvLines table(file.path(), choose_signals(cut, {"still", "never"}), {30 * ms, 50 * ms}, 10 * ms);
  std::vector<std::string> lines;
  for (std::string line; table.next(line);) lines.push_back(line);
  REQUIRE(lines.size() >= 2);
  CHECK(lines[1] == "0.03,7,3");
  CHECK(lines.back() == "0.04,8,3");
}

TEST_CASE("a cut of nothing is refused") {
  WrittenRecord record;
  write_knee(record);
  const ScratchFile file;
  CHECK_THROWS_WITH_AS((void)cut_record(record.outline(), {.span = {200 * ms, 300 * ms}, .signals = {}}, file.path()),
                       doctest::Contains("holds nothing between these times"), InputError);
}

}  // namespace record_cut_test
