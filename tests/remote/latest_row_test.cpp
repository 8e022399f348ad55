#include "remote/instance/latest_row.h"

#include <array>
#include <thread>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"

namespace latest_row_test {

using kadans::LatestRow;

namespace {

// For tests in which nobody writes meanwhile.
LatestRow::View newest(LatestRow& row) {
  const auto reading = row.read();
  return *reading;
}

}  // namespace

TEST_CASE("nothing is copied unless it is wanted, and then each n-th row") {
  LatestRow row(2);
  const std::array<double, 2> values{1, 2};
  row.publish(10, 100, values);
  CHECK(newest(row).values.empty());
  row.want(5);
  row.publish(11, 110, values);
  CHECK(newest(row).values.empty());
  row.publish(15, 150, values);
  CHECK(newest(row).tick == 15);
  CHECK(newest(row).time_ns == 150);
  CHECK(newest(row).values[1] == 2);
  row.publish(20, 200, std::array<double, 1>{7});
  CHECK(newest(row).tick == 15);  // not its length
}

TEST_CASE("publishing a row does not allocate") {
  LatestRow row(3);
  row.want(1);
  const std::array<double, 3> values{1, 2, 3};
  const kadans::testing::AllocationCount heap;
  row.publish(1, 1, values);
  const double last = newest(row).values[2];
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(last == 3);
}

TEST_CASE("a reader beside the writer sees whole rows, newer each time") {
  LatestRow row(64);
  row.want(1);
  constexpr std::uint64_t rows = 20'000;
  std::thread writer([&row] {
    std::array<double, 64> values{};
    for (std::uint64_t tick = 1; tick <= rows; ++tick) {
      values.fill(static_cast<double>(tick));
      row.publish(tick, 0, values);
    }
  });
  std::uint64_t last = 0;
  bool whole = true, ordered = true;
  while (last < rows) {
    const auto reading = row.read();
    const LatestRow::View& view = *reading;
    for (const double value : view.values) whole = whole && value == static_cast<double>(view.tick);
    ordered = ordered && view.tick >= last;
    last = view.tick;
  }
  writer.join();
  CHECK(whole);
  CHECK(ordered);
}

}  // namespace latest_row_test
