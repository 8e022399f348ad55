// Two records beside each other: where they part, and what is no difference.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "telemetry/reading/record_comparison.h"
#include "written_record.h"

using namespace kadans;

namespace {

RecordDiff diff(WrittenRecord& a, WrittenRecord& b, double tolerance = 0) {
  return diff_records(a.outline(), b.outline(), tolerance);
}

// `ticks` rows of knee.angle_rad = tick, but `other` in tick `at`.
void write_steps(WrittenRecord& record, std::uint32_t ticks, std::uint32_t at = 1000, double other = 0) {
  const std::uint16_t knee = record.rows({"knee.angle_rad|rad", "knee.torque_Nm|Nm"});
  for (std::uint32_t tick = 0; tick < ticks; ++tick) record.row(knee, tick, {tick == at ? other : 1.0 * tick, 5});
}

}  // namespace

TEST_CASE("records that hold the same are the same, in whatever chunks and precision") {
  WrittenRecord a, b, single(Precision::single);
  write_knee(a);
  write_knee(b);
  write_knee(single);
  const RecordDiff same = diff(a, b);
  CHECK(same.same());
  CHECK(same.rows == 100);
  CHECK(same.signals == 3);
  CHECK(diff(a, single).same());
}

TEST_CASE("the first difference is found with its time, and the greatest one of each signal") {
  WrittenRecord a, b;
  const auto write = [](WrittenRecord& record, double early, double late) {
    const std::uint16_t knee = record.rows({"knee.angle_rad|rad", "knee.torque_Nm|Nm"});
    for (std::uint32_t tick = 0; tick < 10; ++tick)
      record.row(knee, tick, {tick >= 4 ? early * tick : tick, tick == 8 ? late : 0});
  };
  write(a, 1, 3);
  write(b, 1.5, -3);
  const RecordDiff found = diff(a, b);
  REQUIRE(found.partings.size() == 2);
  CHECK(found.partings[0].name == "knee.angle_rad");
  CHECK(found.partings[0].first_ns == 4'000'000);
  CHECK(found.partings[0].first_b == 6);
  CHECK(found.partings[0].most == 4.5);
  CHECK(found.partings[0].most_ns == 9'000'000);
  CHECK(found.partings[0].rows == 6);
  CHECK(found.partings[1].first_ns == 8'000'000);
  CHECK(found.partings[1].unit == "Nm");
  CHECK_FALSE(found.same());
}

TEST_CASE("a difference within the tolerance is none, one beyond it is, and a number is never as good as none") {
  WrittenRecord a, near, none;
  write_steps(a, 10);
  write_steps(near, 10, 6, 6.001);
  write_steps(none, 10, 6, std::numeric_limits<double>::quiet_NaN());
  CHECK(diff(a, near, 0.01).same());
  CHECK_FALSE(diff(a, near, 0.0001).same());
  const RecordDiff found = diff(a, none, 1e9);
  REQUIRE(found.partings.size() == 1);
  CHECK(std::isinf(found.partings[0].most));
}

TEST_CASE("rows after the end of one record are told, and its signals are compared no further") {
  WrittenRecord a, b;
  write_steps(a, 10);
  write_steps(b, 7);
  const RecordDiff found = diff(a, b);
  CHECK(found.partings.empty());
  CHECK(found.rows == 7);
  CHECK(found.rows_only_a == 3);
  CHECK(found.row_only_a_ns == 7'000'000);
  CHECK(found.rows_only_b == 0);
}

TEST_CASE("a signal that stands still holds its value where one record has a row and the other none") {
  WrittenRecord every, sparse, other;
  const auto write = [](WrittenRecord& record, bool all, double at_five) {
    const std::uint16_t knee = record.rows({"knee.angle_rad|rad"});
    for (std::uint32_t tick = 0; tick < 10; ++tick) {
      if (all || tick == 0 || tick == 5 || tick == 9) record.row(knee, tick, {tick < 5 ? 1 : at_five});
    }
  };
  write(every, true, 2);
  write(sparse, false, 2);
  write(other, false, 3);
  CHECK(diff(every, sparse).same());
  const RecordDiff found = diff(every, other);
  REQUIRE(found.partings.size() == 1);
  CHECK(found.partings[0].first_ns == 5'000'000);
}

TEST_CASE("a signal that one record holds at a slower rate is compared in the ticks that both have") {
  WrittenRecord fast, slow, wrong;
  write_steps(fast, 50);
  const auto write = [](WrittenRecord& record, double shift) {
    const std::uint16_t knee = record.rows({"knee.angle_rad|rad", "knee.torque_Nm|Nm"}, 10);
    for (std::uint32_t tick = 0; tick < 50; tick += 10) record.row(knee, tick, {tick + shift, 5});
  };
  write(slow, 0);
  write(wrong, 0.5);
  CHECK(diff(fast, slow).partings.empty());
  CHECK(diff(fast, wrong).partings.size() == 1);
}

TEST_CASE("transitions, faults, log lines, signals and descriptions of only one record are listed") {
  WrittenRecord a, b;
  for (WrittenRecord* record : {&a, &b}) {
    const bool first = record == &a;
    const std::uint16_t rows = record->rows({"knee.angle_rad|rad", first ? "knee.x_m|m" : "knee.y_m|m"});
    record->describe(0, first ? "{\"kp\": 1}" : "{\"kp\": 2}");
    record->row(rows, 0, {0, 0});
    record->transition(1, "", "up");
    record->transition(first ? 2 : 3, "up", "down");
    if (first) record->fault(4, "tilt", "");
    record->say(5, first ? "yes" : "no");
  }
  const RecordDiff found = diff(a, b);
  CHECK(found.events_only_a.size() == 3);
  CHECK(found.events_only_b.size() == 2);
  CHECK(found.events_only_b[0] == "    0.003 s  bend: up -> down (told)");
  CHECK(found.only_a == std::vector<std::string>{"knee.x_m"});
  CHECK(found.only_b == std::vector<std::string>{"knee.y_m"});
  CHECK(found.other_topics == std::vector<std::string>{"/description"});
  CHECK(found.partings.empty());
  CHECK(differing_facts(a.outline(), b.outline()).empty());
}
