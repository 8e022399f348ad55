#include "telemetry/record/flight_recorder.h"

#include <array>
#include <cmath>
#include <map>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "scratch_file.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/recorder.h"
#include "telemetry/record/signal_topics.h"

namespace flight_recorder_test {

using namespace kadans;

namespace {

constexpr std::int64_t ms = 1'000'000;
const double zero = 0;

SignalTable robot_table() {
  SignalTable table;
  table.add({"joint.knee", "rad", ""}, &zero);
  table.add({"safety.level", "", ""}, &zero);
  return table;
}

// A robot whose faults latch at some ticks, for 200 ticks each.
struct Robot {
  SignalTable table = robot_table();
  Recorder recorder{table, {}, {.kept_s = 5, .bytes = 1U << 20U}};
  std::uint64_t tick = 0;

  void run(std::uint64_t ticks, const std::vector<std::uint64_t>& latches = {}) {
    for (const std::uint64_t end = tick + ticks; tick < end; ++tick) {
      double level = 0;
      for (const std::uint64_t from : latches) level = tick >= from && tick < from + 200 ? 3 : level;
      recorder.record(tick, static_cast<std::int64_t>(tick) * ms,
                      std::array{std::sin(static_cast<double>(tick)), level});
      if (tick % 20 == 19) (void)recorder.drain();
    }
  }
  FlightRecorder& flight() { return *recorder.flight(); }
};

// Of /joint, value by tick; events by topic.
struct Dump {
  std::map<std::uint32_t, double> knee;
  std::map<std::string, int> others;
};

Dump read_dump(const std::string& path) {
  Dump dump;
  McapReader reader(path);
  for (McapMessage message; reader.next(message);) {
    const std::string& topic = reader.channels().at(message.channel).topic;
    ++dump.others[topic];
    std::vector<double> knee(1);
    if (topic == "/joint" && read_cdr(message.payload, knee) == Precision::single)
      dump.knee[message.sequence] = knee[0];
  }
  CHECK(reader.complete());
  return dump;
}

}  // namespace

TEST_CASE("FlightMemory gives back ticks and times to the bit and values in single precision") {
  FlightMemory memory(3, {.kept_s = 10, .bytes = 1U << 20U});
  const auto row = [](std::uint64_t tick) {
    const double t = static_cast<double>(tick);
    return std::array{std::sin(t), 1e-300 * t, tick == 7 ? std::nan("") : -1e30};
  };
  constexpr std::uint64_t first = (std::uint64_t{1} << 40U) + 1;
  for (std::uint64_t i = 0; i < 250; ++i) memory.add(first + i * i, static_cast<std::int64_t>(i) * ms - 3, row(i));
  memory.seal();
  REQUIRE(memory.first() == 0);
  REQUIRE(memory.end() == 3);
  FlightMemory::Rows rows;
  std::uint64_t i = 0;
  for (std::uint64_t block = 0; block < 3; ++block) {
    REQUIRE(memory.read(block, rows));
    for (std::size_t r = 0; r < rows.ticks.size(); ++r, ++i) {
      REQUIRE(rows.ticks[r] == first + i * i);
      REQUIRE(rows.times_ns[r] == static_cast<std::int64_t>(i) * ms - 3);
      REQUIRE(rows.values[3 * r] == static_cast<double>(static_cast<float>(row(i)[0])));
      REQUIRE(rows.values[3 * r + 1] == 0);
      REQUIRE(std::isnan(rows.values[3 * r + 2]) == (i == 7));
    }
  }
  CHECK(i == 250);
  CHECK_FALSE(memory.read(3, rows));
}

TEST_CASE("FlightMemory forgets what is older than it keeps, and more of it when its bytes do not suffice") {
  RandomStream random(1, "noise");
  for (const std::size_t bytes : {std::size_t{1} << 20U, std::size_t{20'000}}) {
    FlightMemory memory(4, {.kept_s = 2, .bytes = bytes});
    FlightMemory::Rows rows;
    for (std::uint64_t tick = 0; tick < 20'000; ++tick) {
      const double loud = tick / 100 % 7 < 3 ? 0 : 1;  // blocks of different sizes
      memory.add(
          tick, static_cast<std::int64_t>(tick) * ms,
          std::array{loud * random.uniform(), random.uniform(), loud * random.uniform(), loud * random.uniform()});
      if (tick % 100 != 99) continue;
      REQUIRE(memory.packed_bytes() <= bytes);
      for (std::uint64_t block = memory.first(); block < memory.end(); ++block) {
        REQUIRE(memory.read(block, rows));
        REQUIRE(rows.ticks.front() == block * 100);
      }
      REQUIRE(rows.ticks.back() == tick);
    }
    const std::uint64_t kept = memory.end() - memory.first();
    CHECK(memory.end() == 200);
    CHECK((bytes > 100'000 ? kept == 21 : kept > 8 && kept < 20));
  }
}

TEST_CASE("FlightMemory keeps the inputs of its ticks, what came down and saved states, within its bytes") {
  const InputLayout layout{.joints = 1, .state_bytes = 50};
  FlightMemory memory(2, {.kept_s = 10, .bytes = 1U << 20U, .inputs = layout});
  const std::vector<std::byte> event(30, std::byte{7}), state(40, std::byte{9});
  std::vector<std::uint64_t> words(layout.words());
  for (std::uint64_t tick = 5000; tick < 5250; ++tick) {
    for (std::size_t w = 0; w < words.size(); ++w) words[w] = tick * (w + 1);
    if (tick == 5110) memory.add_behavior_inputs(event);
    if (tick == 5230) memory.add_state({5229, {}, state});
    memory.add(tick, static_cast<std::int64_t>(tick) * ms, std::array{0.5, 1.0}, words);
  }
  memory.seal();
  REQUIRE(memory.end() == 3);
  struct None final : SignalBits {
    std::optional<std::uint64_t> bits(std::uint64_t, std::uint32_t) const override { return std::nullopt; }
  } none;
  for (std::uint64_t block = 0; block < 3; ++block) {
    FlightMemory::Rows rows;
    REQUIRE(memory.read(block, rows));
    InputDecoder decoder(layout);
    std::deque<TickTaken> ticks;
    REQUIRE(decoder.decode(rows.inputs, none, ticks));
    CHECK(ticks.size() == rows.ticks.size());
    CHECK(ticks.back().words[3] == ticks.back().tick * 4);
    CHECK(rows.values[1] == 1.0);
    CHECK(rows.behaviors.size() == (block == 1 ? event.size() : 0));
    REQUIRE(rows.states.size() == (block == 2 ? 1 : 0));
    std::vector<std::int64_t> found;
    EngineStates::Saved saved;
    if (block == 2) CHECK(take_state(rows.states[0], found, saved));
    if (block == 2) CHECK(saved.tick == 5229);
  }
}

TEST_CASE("FlightMemory drops signals before inputs where its bytes do not suffice, but not the last third of them") {
  RandomStream random(1, "noise");
  const InputLayout layout{.joints = 1, .state_bytes = 50};
  const std::size_t bytes = 600'000;  // a fifth of them are the encoder's
  const auto kept = [&](double kept_s, std::size_t noisy_words) {
    FlightMemory memory(20, {.kept_s = kept_s, .bytes = bytes, .inputs = layout});
    std::vector<std::uint64_t> words(layout.words());
    std::vector<double> row(20);
    for (std::uint64_t tick = 0; tick < 20'000; ++tick) {
      for (double& value : row) value = random.uniform();
      for (std::size_t w = 0; w < noisy_words; ++w) words[w] = random.next();
      memory.add(tick, static_cast<std::int64_t>(tick) * ms, row, words);
    }
    struct {
      std::size_t blocks = 0, with_rows = 0;
    } counted;
    FlightMemory::Rows rows;
    for (std::uint64_t block = memory.first(); block < memory.end(); ++block) {
      REQUIRE(memory.read(block, rows));
      CHECK_FALSE(rows.inputs.empty());
      CHECK(rows.last_ns == static_cast<std::int64_t>(block * 100 + 99) * ms);
      ++counted.blocks;
      if (!rows.ticks.empty()) {
        ++counted.with_rows;
        CHECK(rows.ticks.front() == block * 100);
        CHECK(rows.values.size() == 20 * rows.ticks.size());
      } else {
        CHECK(counted.with_rows == 0);  // the oldest
      }
    }
    CHECK(memory.rows() == 100 * counted.with_rows);
    CHECK(memory.packed_bytes() <= bytes);
    return counted;
  };
  const auto few = kept(10, 1);  // 8 bytes of inputs a tick, and 80 of signals
  CHECK(few.blocks == 101);
  CHECK(few.with_rows > 35);
  CHECK(few.with_rows < 55);
  const auto many = kept(100, 3);
  CHECK(many.with_rows >= 18);
  CHECK(many.with_rows < 24);
  CHECK(many.blocks > 80);
  CHECK(many.blocks < 150);
}

TEST_CASE("FlightMemory packs what moves slowly, and what stands still into next to nothing") {
  RandomStream random(1, "noise");
  FlightMemory memory(10, {.kept_s = 30, .bytes = 8U << 20U});
  std::vector<double> row(10, 3.25);
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    row[0] = std::sin(0.01 * static_cast<double>(tick)) + 1e-5 * random.uniform();
    memory.add(tick, static_cast<std::int64_t>(tick) * ms, row);
  }
  CHECK(memory.packed_bytes() < 4000);  // of 80,000
}

TEST_CASE("A fault that latches is due a second later, the dump holds what was kept before, and that second") {
  const ScratchFile file;
  Robot robot;
  BehaviorLog log{&robot.recorder.events()};
  log.message(1000 * ms, BehaviorLog::Severity::info, "squat", "long forgotten");
  log.message(7900 * ms, BehaviorLog::Severity::error, "squat", "slips");
  robot.run(8000, {8000});
  CHECK_FALSE(robot.flight().due());
  robot.recorder.fault({.code = FaultCode::fall, .tick = 8000});
  robot.run(1000, {8000});
  CHECK_FALSE(robot.flight().due());
  robot.run(20, {8000});
  REQUIRE(robot.flight().due());
  REQUIRE(robot.flight().begin(file.path()));
  robot.run(1000);  // a few blocks a drain
  CHECK_FALSE(robot.flight().busy());
  CHECK(robot.flight().dumps() == 1);
  CHECK(robot.flight().error().empty());
  CHECK_FALSE(robot.flight().due());
  const Dump dump = read_dump(file.path());
  REQUIRE_FALSE(dump.knee.empty());
  const std::uint32_t last = dump.knee.rbegin()->first, first = dump.knee.begin()->first;
  CHECK(last == 9019);
  CHECK(first <= 4019);
  CHECK(dump.knee.size() == last - first + 1);
  CHECK(dump.knee.at(8123) == static_cast<double>(static_cast<float>(std::sin(8123.0))));
  CHECK(dump.others.at("/faults") == 1);
  CHECK(dump.others.at("/log") == 1);
  CHECK(robot.recorder.dropped() == 0);
}

TEST_CASE("Faults that latch within the time that is kept give one dump, a later one another") {
  const ScratchFile first, second;
  Robot robot;
  const std::vector<std::uint64_t> latches{1000, 2500, 4000, 7000};
  robot.run(2100, latches);
  REQUIRE(robot.flight().due());
  REQUIRE(robot.flight().begin(first.path()));
  robot.flight().finish();
  robot.run(4000, latches);
  CHECK_FALSE(robot.flight().due());
  CHECK_FALSE(robot.flight().due(true));
  robot.run(1000, latches);
  CHECK_FALSE(robot.flight().due());
  CHECK(robot.flight().due(true));  // the run ends within the second
  REQUIRE(robot.flight().begin(second.path()));
  robot.flight().finish();
  CHECK(read_dump(second.path()).knee.rbegin()->first == 7099);
}

TEST_CASE("A fault that latches on a further robot is due, too, also while the first one is held") {
  SignalTable table = robot_table();
  table.add({"left.safety.level", "", ""}, &zero);
  Recorder recorder(table, {}, {.kept_s = 1, .bytes = 1U << 20U});
  const auto run = [&recorder](std::uint64_t from, std::uint64_t to, double level, double left) {
    for (std::uint64_t tick = from; tick < to; ++tick)
      recorder.record(tick, static_cast<std::int64_t>(tick) * ms, std::array{0.0, level, left});
    (void)recorder.drain();
    return recorder.flight()->due(true);
  };
  const ScratchFile file;
  CHECK_FALSE(run(0, 100, 1, 1));
  CHECK(run(100, 200, 3, 1));
  REQUIRE(recorder.flight()->begin(file.path()));
  recorder.flight()->finish();
  CHECK_FALSE(run(200, 1300, 3, 1));
  CHECK(run(1300, 1400, 3, 4));
}

TEST_CASE("A rung that the end of a run asks for is no fault, a file that cannot be written is told") {
  Robot robot;
  robot.flight().watch_no_more();
  robot.run(2000, {500});
  CHECK_FALSE(robot.flight().due(true));
  CHECK_FALSE(robot.flight().begin("/nowhere/at/all.mcap"));
  CHECK(robot.flight().error().find("/nowhere/at/all.mcap") != std::string::npos);
  CHECK_FALSE(robot.flight().busy());
}

TEST_CASE("A record that is opened and closed meanwhile does not disturb the flight recorder") {
  const ScratchFile record, flight;
  Robot robot;
  robot.run(1000);
  REQUIRE(robot.recorder.open(record.path()));
  robot.run(1000);
  REQUIRE(robot.recorder.close());
  robot.run(1000);
  CHECK(robot.recorder.rows() == 1000);
  REQUIRE(robot.flight().begin(flight.path()));
  robot.flight().finish();
  CHECK(read_dump(flight.path()).knee.size() == 3000);
}

TEST_CASE("A dump loses no rows to those that come while it is written") {
  const ScratchFile file;
  RandomStream random(1, "noise");
  const SignalTable table = robot_table();
  const InputLayout layout{.joints = 1, .state_bytes = 50};
  FlightRecorder flight(table, {.kept_s = 100, .bytes = 600'000, .inputs = layout}, {});
  std::vector<std::uint64_t> words(layout.words());
  std::uint64_t tick = 0;
  const auto run = [&](std::uint64_t ticks) {
    for (const std::uint64_t end = tick + ticks; tick < end; ++tick) {
      for (std::size_t w = 0; w < 3; ++w) words[w] = random.next();
      flight.row(tick, static_cast<std::int64_t>(tick) * ms, std::array{random.uniform(), random.uniform()}, words);
      if (tick % 20 == 19) flight.step();
    }
  };
  run(20'000);
  REQUIRE(flight.begin(file.path()));
  run(2'000);
  CHECK_FALSE(flight.busy());
  McapReader reader(file.path());
  for (McapMessage message; reader.next(message);) {
  }
  CHECK(reader.metadata().at("recorder").at("dropped_rows") == "0");
}

TEST_CASE("A dump tells how many rows did not fit into the memory, and holds those before and after") {
  const ScratchFile file;
  const SignalTable table = robot_table();
  FlightRecorder flight(table, {.kept_s = 5, .bytes = 800}, {});
  RandomStream random(1, "noise");
  for (std::uint64_t tick = 0; tick < 430; ++tick) {
    const bool loud = tick / 100 % 2 == 1;  // such a block is larger than the memory
    flight.row(tick, static_cast<std::int64_t>(tick) * ms,
               std::array{loud ? random.uniform() : 0.5, loud ? random.uniform() : 0.0});
  }
  REQUIRE(flight.begin(file.path()));
  flight.finish();
  CHECK(flight.error().empty());
  const Dump dump = read_dump(file.path());
  CHECK(dump.knee.contains(0));
  CHECK(dump.knee.contains(429));
  CHECK_FALSE(dump.knee.contains(150));
  McapReader reader(file.path());
  for (McapMessage message; reader.next(message);) {
  }
  const TextMap& told = reader.metadata().at("recorder");
  CHECK(told.at("rows") == "230");
  CHECK(told.at("dropped_rows") == "200");
}

}  // namespace flight_recorder_test
