#include "telemetry/reading/record_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "scratch_file.h"
#include "telemetry/record/recorder.h"

namespace record_comparison_test {

using namespace kadans;

namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr std::uint64_t ticks = 100;
const double zero = 0;
const double no_number = std::numeric_limits<double>::quiet_NaN();

SignalTable table(const std::vector<std::string>& names) {
  SignalTable signals;
  for (const std::string& name : names) signals.add({name, "rad", "A signal."}, &zero);
  return signals;
}

const std::vector<std::string> usual{"joint.knee", "base.tilt", "joint.hip", "behavior.squat.heap_bytes"};

std::vector<double> row_at(std::uint64_t tick) {
  const double t = static_cast<double>(tick);
  return {std::sin(t), tick == 50 ? no_number : 0.1 * t, tick % 2 == 0 ? 0.0 : -0.0, 1000 + t};
}

void record(const ScratchFile& file, const RecorderSettings& settings = {}) {
  const SignalTable signals = table(usual);
  Recorder recorder(signals, settings);
  REQUIRE(recorder.open(file.path()));
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, row_at(tick));
    REQUIRE(recorder.drain());
  }
  REQUIRE(recorder.close());
}

// The run once more, with one signal of one tick other by so much.
template <typename Row>
void run(RecordComparison& comparison, Row row) {
  for (std::uint64_t tick = 0; tick < ticks + 20; ++tick)
    comparison.compare(tick, static_cast<std::int64_t>(tick) * ms, row(tick));
}

}  // namespace

TEST_CASE("A run that repeats its record is the same in every tick, NaN and both zeros included") {
  const ScratchFile file;
  record(file);
  McapReader reader(file.path());
  const SignalTable signals = table(usual);
  RecordComparison comparison(reader, signals);
  run(comparison, [](std::uint64_t tick) {
    std::vector<double> row = row_at(tick);
    row[2] = -row[2];
    row[3] = 0;  // memory of an interpreter
    return row;
  });
  CHECK_FALSE(comparison.parted());
  CHECK(comparison.ended());
  CHECK(comparison.ticks() == ticks);
  CHECK(comparison.signals() == 3);
}

TEST_CASE("The first tick in which any signal differs is found, with all signals of it in the order of the table") {
  const ScratchFile file;
  record(file);
  McapReader reader(file.path());
  const SignalTable signals = table(usual);
  RecordComparison comparison(reader, signals);
  run(comparison, [](std::uint64_t tick) {
    std::vector<double> row = row_at(tick);
    if (tick >= 37) row[2] = 1;
    if (tick >= 37) row[0] = std::nextafter(row[0], 2);
    return row;
  });
  CHECK(comparison.parted());
  CHECK(comparison.tick() == 37);
  CHECK(comparison.time_ns() == 37 * ms);
  CHECK(comparison.ticks() == 37);
  REQUIRE(comparison.differences().size() == 2);
  CHECK(comparison.differences()[0].name == "joint.knee");
  CHECK(comparison.differences()[0].recorded == std::sin(37.0));
  CHECK(comparison.differences()[0].replayed == std::nextafter(std::sin(37.0), 2));
  CHECK(comparison.differences()[1].name == "joint.hip");
}

TEST_CASE("A value that becomes NaN, or stops being it, differs") {
  for (const std::uint64_t other : {std::uint64_t{20}, std::uint64_t{50}}) {
    const ScratchFile file;
    record(file);
    McapReader reader(file.path());
    const SignalTable signals = table(usual);
    RecordComparison comparison(reader, signals);
    run(comparison, [other](std::uint64_t tick) {
      std::vector<double> row = row_at(tick);
      if (tick == other) row[1] = tick == 50 ? 5.0 : no_number;
      return row;
    });
    CHECK(comparison.tick() == other);
  }
}

TEST_CASE("A record in single precision, of fewer ticks and fewer topics is compared in what it has") {
  const ScratchFile file;
  record(file, {.every_ticks = {10, 0, 10, 0}, .precision = Precision::single});
  const SignalTable signals = table(usual);
  for (const double by : {1e-12, 1e-3}) {
    McapReader reader(file.path());
    RecordComparison comparison(reader, signals);
    run(comparison, [by](std::uint64_t tick) {
      std::vector<double> row = row_at(tick);
      row[1] = 9;
      if (tick > 30) row[0] += by;
      return row;
    });
    CHECK(comparison.signals() == 2);
    CHECK(comparison.parted() == (by > 1e-6));
    CHECK(comparison.ticks() == (by > 1e-6 ? 4 : 10));
  }
}

TEST_CASE("Signals that the run no longer has are told, the others are compared, wherever they stand now") {
  const ScratchFile file;
  record(file);
  McapReader reader(file.path());
  const SignalTable signals = table({"base.new", "joint.hip", "joint.knee"});
  RecordComparison comparison(reader, signals);
  run(comparison, [](std::uint64_t tick) {
    const std::vector<double> row = row_at(tick);
    return std::vector<double>{7, row[2], row[0]};
  });
  CHECK_FALSE(comparison.parted());
  CHECK(comparison.ticks() == ticks);
  REQUIRE(comparison.gone().size() == 1);
  CHECK(comparison.gone()[0] == "base.tilt");
}

TEST_CASE("A topic that stands still is written seldom and compared in every tick all the same") {
  const ScratchFile file;
  const SignalTable signals = table({"moves.a", "stands.b"});
  const auto recorded = [](std::uint64_t tick) {
    return std::vector<double>{static_cast<double>(tick), tick < 40 ? 1.0 : 2.0};
  };
  {
    Recorder recorder(signals);
    REQUIRE(recorder.open(file.path()));
    for (std::uint64_t tick = 0; tick < ticks; ++tick)
      recorder.record(tick, static_cast<std::int64_t>(tick) * ms, recorded(tick));
    REQUIRE(recorder.close());
  }
  for (const std::uint64_t other : {std::uint64_t{500}, std::uint64_t{20}, std::uint64_t{39}, std::uint64_t{40}}) {
    McapReader reader(file.path());
    RecordComparison comparison(reader, signals);
    run(comparison, [&](std::uint64_t tick) {
      std::vector<double> row = recorded(tick);
      if (tick == other) row[1] += 1;
      return row;
    });
    CHECK(comparison.parted() == (other < ticks));
    CHECK(comparison.ticks() == std::min(other, ticks));
  }
}

}  // namespace record_comparison_test
