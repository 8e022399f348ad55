#include "telemetry/record/recorder.h"

#include <array>
#include <atomic>
#include <stdexcept>
#include <thread>

#include <doctest/doctest.h>

#include "kadans/testing/real_time_guard.h"
#include "scratch_file.h"
#include "telemetry/mcap/mcap_reader.h"

namespace recorder_test {

using namespace kadans;

namespace {

constexpr std::int64_t ms = 1'000'000;
const double zero = 0;

SignalTable small_table() {
  SignalTable table;
  table.add({"joint.l_knee.position_rad", "rad", "Position."}, &zero);
  table.add({"base.tilt_rad", "rad", "Tilt."}, &zero);
  table.add({"joint.r_knee.position_rad", "rad", "Position."}, &zero);
  return table;
}

SignalTable wide_table(int signals) {
  SignalTable table;
  for (int i = 0; i < signals; ++i) table.add({"s.v" + std::to_string(i), "", ""}, &zero);
  return table;
}

struct Entry {
  std::string topic;
  std::uint32_t sequence = 0;
  std::int64_t time_ns = 0;
  std::string payload;
};

std::vector<Entry> entries_of(const std::string& path) {
  std::vector<Entry> entries;
  McapReader reader(path);
  for (McapMessage message; reader.next(message);) {
    entries.push_back({reader.channels().at(message.channel).topic, message.sequence, message.time_ns,
                       std::string(reinterpret_cast<const char*>(message.payload.data()), message.payload.size())});
  }
  CHECK(reader.complete());
  return entries;
}

std::size_t count(const std::vector<Entry>& entries, std::string_view topic) {
  std::size_t found = 0;
  for (const Entry& entry : entries) found += entry.topic == topic ? 1U : 0U;
  return found;
}

}  // namespace

TEST_CASE("Recorder writes each row under its topics, in schema order, with the tick as sequence") {
  const ScratchFile file;
  const SignalTable table = small_table();
  Recorder recorder(table);
  REQUIRE(recorder.open(file.path()));
  recorder.record(1000, 1000 * ms, std::array{0.25, 0.5, 0.75});
  REQUIRE(recorder.close());
  const auto entries = entries_of(file.path());
  REQUIRE(entries.size() == 2);
  CHECK(entries[0].topic == "/joint");
  CHECK(entries[0].sequence == 1000);
  CHECK(entries[0].time_ns == 1000 * ms);
  std::array<double, 2> knees{};
  REQUIRE(read_cdr(bytes_of(entries[0].payload), knees) == Precision::full);
  CHECK(knees[0] == 0.25);
  CHECK(knees[1] == 0.75);
  CHECK(entries[1].topic == "/base");
}

TEST_CASE("Recorder records signals at the rates chosen and leaves out those with none") {
  const ScratchFile file;
  const SignalTable table = small_table();
  Recorder recorder(table, {.every_ticks = {0, 10, 0}});
  REQUIRE(recorder.open(file.path()));
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    const double t = static_cast<double>(tick);
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, std::array{t, t, t});
  }
  REQUIRE(recorder.close());
  const auto entries = entries_of(file.path());
  CHECK(count(entries, "/base") == 10);
  CHECK(count(entries, "/joint") == 0);
  CHECK(entries[3].sequence == 30);
  CHECK(recorder.rows() == 10);
}

TEST_CASE("Signals of one topic with different rates go to a topic for each rate, the fastest under the usual name") {
  const ScratchFile file;
  const SignalTable table = small_table();
  Recorder recorder(table, {.every_ticks = {10, 0, 2}});
  REQUIRE(recorder.open(file.path()));
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    const double t = static_cast<double>(tick);
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, std::array{t, t, -t});
  }
  REQUIRE(recorder.close());
  const auto entries = entries_of(file.path());
  CHECK(count(entries, "/joint") == 10);
  CHECK(count(entries, "/joint/every_10") == 2);
  CHECK(recorder.rows() == 10);
  std::array<double, 1> knee{};
  REQUIRE(read_cdr(bytes_of(entries.back().payload), knee) == Precision::full);
  CHECK(knee[0] == -18);
}

TEST_CASE("A topic that stands still is written each 100 ticks, and before and after it moves") {
  const ScratchFile file;
  const SignalTable table = small_table();
  Recorder recorder(table);
  REQUIRE(recorder.open(file.path()));
  for (std::uint64_t tick = 0; tick < 250; ++tick) {
    const double t = static_cast<double>(tick);
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, std::array{t, tick < 170 ? 1.0 : 2.0, t});
  }
  REQUIRE(recorder.close());
  std::vector<std::uint32_t> ticks;
  for (const Entry& entry : entries_of(file.path())) {
    if (entry.topic == "/base") ticks.push_back(entry.sequence);
  }
  CHECK(ticks == std::vector<std::uint32_t>{0, 100, 169, 170, 249});
}

TEST_CASE("Recorder writes transitions and messages as JSON between the rows, in order of time") {
  const ScratchFile file;
  const SignalTable table = small_table();
  Recorder recorder(table, {.every_ticks = {0, 1, 0}});
  REQUIRE(recorder.open(file.path()));
  recorder.record(1, 1 * ms, std::array{0.0, 0.0, 0.0});
  BehaviorLog log{&recorder.events()};
  log.transition({.time_ns = 2 * ms, .behavior = "squat", .from = "", .to = "down", .why = "start"});
  log.message(1'500'000'002, BehaviorLog::Severity::error, "squat", "line \xff\n\"end\"");
  recorder.record(3, 3 * ms, std::array{0.0, 1.0, 0.0});
  REQUIRE(recorder.close());
  const auto entries = entries_of(file.path());
  REQUIRE(entries.size() == 4);
  CHECK(entries[0].topic == "/base");
  CHECK(entries[1].topic == "/transitions");
  CHECK(entries[1].payload ==
        R"({"behavior":"squat","from":"","timestamp":{"nsec":2000000,"sec":0},"to":"down","why":"start"})");
  CHECK(entries[2].topic == "/base");
  CHECK(entries[3].topic == "/log");
  CHECK(entries[3].payload == R"({"file":"","level":4,"line":0,"message":"line )"
                              "\xef\xbf\xbd"
                              R"(\n\"end\"","name":"squat",)"
                              R"("timestamp":{"nsec":500000002,"sec":1}})");
}

TEST_CASE("Recorder: when nobody drains, rows are dropped, counted, and told in the record") {
  const ScratchFile file;
  constexpr std::uint64_t rows = 2000;
  const SignalTable table = wide_table(498);
  Recorder recorder(table, {.standstill_ticks = 1});  // 500 words a row: 524 rows fit
  REQUIRE(recorder.open(file.path()));
  const std::vector<double> row(498, 1.0);
  for (std::uint64_t tick = 0; tick < rows; ++tick) recorder.record(tick, static_cast<std::int64_t>(tick) * ms, row);
  CHECK(recorder.dropped() == rows - 524);
  REQUIRE(recorder.drain());
  recorder.record(rows, static_cast<std::int64_t>(rows) * ms, row);
  REQUIRE(recorder.close());
  CHECK(recorder.dropped() == rows - 524);
  const auto entries = entries_of(file.path());
  CHECK(count(entries, "/s") == 525);
  REQUIRE(count(entries, "/log") == 1);
  for (const Entry& entry : entries) {
    if (entry.topic == "/log") CHECK(entry.payload.find("1476 rows and 0 events so far") != std::string::npos);
  }
  CHECK(entries.back().sequence == rows);
}

TEST_CASE("Recorder::record neither allocates, locks nor touches files, also when the ring is full") {
  const SignalTable table = wide_table(498);
  Recorder recorder(table);
  const std::vector<double> row(498, 1.0);
  {
    const testing::RealTimeGuard guard;  // aborts
    for (std::uint64_t tick = 0; tick < 1100; ++tick) recorder.record(tick, 0, row);
  }
  CHECK(recorder.dropped() == 1100 - 524);
}

TEST_CASE("Recorder counts a row of the wrong size as dropped") {
  const SignalTable table = small_table();
  Recorder recorder(table);
  recorder.record(0, 0, std::array{1.0});
  CHECK(recorder.dropped() == 1);
}

TEST_CASE("Recorder: events that do not fit are dropped and counted, those that fit arrive") {
  const ScratchFile file;
  const SignalTable table = small_table();
  Recorder recorder(table);
  REQUIRE(recorder.open(file.path()));
  const std::string text(1000, 'x');
  BehaviorLog log{&recorder.events()};
  for (int i = 0; i < 300; ++i) log.message(i, BehaviorLog::Severity::info, "flood", text);
  CHECK(recorder.dropped_events() > 30);
  CHECK(recorder.dropped_events() < 60);
  REQUIRE(recorder.close());
  CHECK(count(entries_of(file.path()), "/log") == 300 - recorder.dropped_events() + 1);
}

TEST_CASE("Recorder: a full disk is told by error(), the ring is emptied all the same, the loop sees no drops") {
  const SignalTable table = wide_table(498);
  Recorder recorder(table);
  CHECK_FALSE(recorder.open("/dev/full"));
  CHECK(recorder.error().find("No space left on device") != std::string::npos);
  const std::vector<double> row(498, 1.0);
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, row);
    if (tick % 100 == 99) CHECK_FALSE(recorder.drain());
  }
  CHECK(recorder.dropped() == 0);
  CHECK(recorder.rows() == 3000);
  CHECK(recorder.lost() == 3000);
  CHECK_FALSE(recorder.close());
}

TEST_CASE("Recorder describes run and robot: metadata, attachment, and the URDF on /robot_description") {
  const ScratchFile file;
  const SignalTable table = small_table();
  Recorder recorder(table);
  REQUIRE(recorder.open(file.path()));
  REQUIRE(recorder.file().describe_run({.run = {{"scenario", "squat"}, {"seed", "7"}}}));
  REQUIRE(recorder.file().describe_robot("tulip", "<robot/>", 0));
  REQUIRE(recorder.close());
  McapReader reader(file.path());
  McapMessage message;
  REQUIRE(reader.next(message));
  CHECK(reader.channels().at(message.channel).topic == "/robot_description");
  CHECK(message.payload.size() == 4 + 4 + 8 + 1);
  CHECK_FALSE(reader.next(message));
  CHECK(reader.metadata().at("run").at("seed") == "7");
  CHECK(reader.metadata().at("recorder").at("dropped_rows") == "0");
  REQUIRE(reader.attachments().size() == 1);
  CHECK(reader.attachments()[0].name == "tulip.urdf");
}

TEST_CASE("Recorder tells of a further robot: its URDF on a topic of its own, its faults with its name") {
  const ScratchFile file;
  const SignalTable table = small_table();
  ViewerSubjects subjects{.joints = {"l_knee", "r_knee"}, .base = "torso", .feet = {}};
  subjects.others.push_back({.joints = {"elbow"}, .base = "arm", .feet = {}, .robot = "left"});
  Recorder recorder(table, {.subjects = subjects});
  REQUIRE(recorder.open(file.path()));
  REQUIRE(recorder.file().describe_robot("tulip", "<robot/>", 0));
  REQUIRE(recorder.file().describe_other("left", "<robot/>", 0));
  recorder.fault({.code = FaultCode::motor_hot, .joint = 1, .tick = 4});
  recorder.fault({.code = FaultCode::motor_hot, .joint = 0, .robot = 1, .tick = 4});
  recorder.fault({.code = FaultCode::fall, .robot = 1, .tick = 4});
  REQUIRE(recorder.close());
  std::vector<std::string> joints;
  const std::vector<Entry> entries = entries_of(file.path());
  for (const Entry& entry : entries) {
    if (entry.topic != "/faults") continue;
    const std::size_t at = entry.payload.find("\"joint\":\"");
    REQUIRE(at != std::string::npos);
    joints.push_back(entry.payload.substr(at + 9, entry.payload.find('"', at + 9) - at - 9));
  }
  CHECK(joints == std::vector<std::string>{"r_knee", "left.elbow", "left"});
  CHECK(count(entries, "/robot_description") == 1);
  CHECK(count(entries, "/left/robot_description") == 1);
}

TEST_CASE("Recorder: with a thread that drains, every row arrives whole and in order or is counted") {
  const ScratchFile file;
  constexpr std::uint64_t rows = 20'000;
  const SignalTable table = wide_table(100);
  Recorder recorder(table);
  REQUIRE(recorder.open(file.path()));
  std::atomic<bool> done{false};
  std::thread drainer([&] {
    while (!done.load()) (void)recorder.drain();
  });
  std::vector<double> row(100);
  for (std::uint64_t tick = 0; tick < rows; ++tick) {
    row.assign(row.size(), static_cast<double>(tick));
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, row);
  }
  done = true;
  drainer.join();
  REQUIRE(recorder.close());
  std::size_t arrived = 0;
  std::int64_t last = -1;
  std::vector<double> values(100);
  for (const Entry& entry : entries_of(file.path())) {
    if (entry.topic != "/s") continue;
    ++arrived;
    REQUIRE(std::int64_t{entry.sequence} > last);
    last = entry.sequence;
    REQUIRE(read_cdr(bytes_of(entry.payload), values) == Precision::full);
    REQUIRE(values.front() == static_cast<double>(entry.sequence));
    REQUIRE(values.back() == values.front());
  }
  CHECK(arrived + recorder.dropped() == rows);
}

TEST_CASE("Recorder tells all parameters at the start, then each change") {
  const ScratchFile file;
  const SignalTable table = small_table();
  ParameterTable parameters;
  double stiffness = 0, damping = 0;
  const auto kp = parameters.add({"knee.kp", "Nm/rad", 0, 100, 40, ""}, &stiffness);
  parameters.add({"knee.kd", "Nms/rad", 0, 10, 2, ""}, &damping);
  Recorder recorder(table, {.parameters = &parameters});
  REQUIRE(recorder.open(file.path()));
  for (std::uint64_t tick = 3; tick < 100; ++tick) {
    if (tick == 41) REQUIRE(parameters.set(kp, 55));
    recorder.record(tick, static_cast<std::int64_t>(tick) * ms, std::array{0.0, 0.0, 0.0});
    REQUIRE(recorder.drain());
  }
  REQUIRE(recorder.close());
  std::vector<Entry> told;
  for (Entry& entry : entries_of(file.path())) {
    if (entry.topic == "/parameters") told.push_back(std::move(entry));
  }
  REQUIRE(told.size() == 2);
  CHECK(told[0].time_ns == 3 * ms);
  CHECK(told[0].payload.find(R"([{"name":"knee.kp","value":40.0},{"name":"knee.kd","value":2.0}])") !=
        std::string::npos);
  CHECK(told[1].time_ns == 50 * ms);
  CHECK(told[1].payload.find(R"("parameters":[{"name":"knee.kp","value":55.0}])") != std::string::npos);
}

TEST_CASE("A record goes on in another file without losing a row, and each file is whole") {
  const SignalTable table = small_table();
  const ScratchFile one, other;
  const std::string first = one.path(), second = other.path();
  Recorder recorder(table, {.standstill_ticks = 1, .subjects = {}});
  REQUIRE(recorder.open(first));
  std::array<double, 3> row{};
  const auto record = [&](std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t tick = from; tick < to; ++tick) {
      row.fill(static_cast<double>(tick));
      recorder.record(tick, static_cast<std::int64_t>(tick) * ms, row);
    }
  };
  record(0, 100);
  REQUIRE(recorder.go_on_in(second));
  record(100, 150);
  REQUIRE(recorder.close());
  std::vector<std::uint32_t> ticks;
  for (const std::string& file : {first, second}) {
    for (const Entry& entry : entries_of(file)) {
      if (entry.topic == "/base") ticks.push_back(entry.sequence);
    }
  }
  REQUIRE(ticks.size() == 150);
  for (std::uint32_t i = 0; i < 150; ++i) CHECK(ticks[i] == i);
  CHECK(count(entries_of(first), "/base") == 100);
}

}  // namespace recorder_test
