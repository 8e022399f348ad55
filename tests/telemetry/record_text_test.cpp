// Rows as lines of JSON and as tables: the same numbers, in the order of the file.
#include <limits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "kadans/signal/input_error.h"
#include "telemetry/reading/record_export.h"
#include "written_record.h"

namespace record_text_test {

using namespace kadans;

namespace {

constexpr std::int64_t ms = 1'000'000;

template <typename Lines>
std::vector<std::string> all_of(Lines&& lines) {
  std::vector<std::string> all;
  for (std::string line; lines.next(line);) all.push_back(line);
  return all;
}

CsvLines csv(const RecordOutline& record, const std::vector<std::string>& signals, TimeSpan span = {},
             std::optional<std::int64_t> every_ns = std::nullopt) {
  return CsvLines(record.file, choose_signals(record, signals), span, every_ns);
}

std::string number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string time(std::int64_t time_ns) {
  std::string text;
  append_seconds(text, time_ns);
  return text;
}

}  // namespace

TEST_CASE("a number is written with as many digits as it takes to read the same one again, and no more") {
  CHECK(number(0.1) == "0.1");
  CHECK(number(0.1 + 0.2) == "0.30000000000000004");
  CHECK(number(-3) == "-3");
  CHECK(number(std::numeric_limits<double>::quiet_NaN()) == "nan");
  CHECK(time(1'500'000'000) == "1.5");
  CHECK(time(1) == "0.000000001");
  CHECK(time(-20 * ms) == "-0.02");
  CHECK(time(7'000'000'000) == "7");
  CHECK(time(100'000'000'000) == "100");
}

TEST_CASE("every message of a record is a line of JSON with its time, its topic and what it says") {
  WrittenRecord record;
  write_knee(record);
  std::vector<nlohmann::json> lines;
  for (const std::string& line : all_of(JsonLines(record.path(), {}, {}))) lines.push_back(nlohmann::json::parse(line));
  CHECK(lines.size() == 100 + 10 + 2 + 1 + 1 + 1);
  std::map<std::string, nlohmann::json> last;
  for (const auto& line : lines) last[line["topic"]] = line;
  CHECK(last["/knee"]["tick"] == 99);
  CHECK(last["/knee"]["time_s"] == 0.099);
  CHECK(last["/knee"]["knee.angle_rad"] == 1e-3 * 99);
  CHECK(last["/knee"]["knee.torque_Nm"] == -99.0);
  CHECK(last["/transitions"]["to"] == "up");
  CHECK_FALSE(last["/transitions"].contains("timestamp"));
  CHECK(last["/faults"]["joint"] == "knee");
  CHECK(last["/log"]["message"] == "so \"far\"");
  CHECK(last["/description"]["robot"]["name"] == "leg");
}

TEST_CASE("lines of JSON are of the topics and the time that are asked for, and a number that is none is null") {
  WrittenRecord record;
  const std::uint16_t knee = record.rows({"knee.angle_rad|rad"});
  record.row(knee, 1, {1});
  record.row(knee, 2, {std::numeric_limits<double>::infinity()});
  record.say(2, "odd");
  record.row(knee, 3, {3});
  const std::string file = record.path();
  const std::vector<std::string> lines = all_of(JsonLines(file, {"knee"}, {2 * ms, 2 * ms}));
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == R"({"time_s":0.002,"topic":"/knee","tick":2,"knee.angle_rad":null})");
  JsonLines wrong(file, {"kne", "/l*"}, {});
  CHECK(all_of(wrong).size() == 1);
  CHECK(wrong.unknown_topics() == std::vector<std::string>{"kne"});
}

TEST_CASE("a table has a line for each time with a row, and a slower signal holds its value between its rows") {
  WrittenRecord record;
  write_knee(record);
  const std::vector<std::string> lines = all_of(csv(record.outline(), {"slow", "knee.angle_rad"}));
  REQUIRE(lines.size() == 101);
  CHECK(lines[0] == "time_s,slow.temperature_C [C],knee.angle_rad [rad]");
  CHECK(lines[1] == "0,20,0");
  CHECK(lines[12] == "0.011,20.1,0.011");
  CHECK(lines[100] == "0.099,20.9,0.099");
}

TEST_CASE("a row that comes late because its topic stood still changes no line") {
  WrittenRecord record;
  const std::uint16_t still = record.rows({"still.value|"}), knee = record.rows({"knee.angle_rad|rad"});
  for (std::uint32_t tick = 0; tick < 4; ++tick) {
    if (tick == 0) record.row(still, 0, {7});
    if (tick == 3) record.row(still, 2, {7});  // what it was until now
    if (tick == 3) record.row(still, 3, {8});
    record.row(knee, tick, {1.0 * tick});
  }
  CHECK(all_of(csv(record.outline(), {})) == std::vector<std::string>{"time_s,still.value,knee.angle_rad [rad]",
                                                                      "0,7,0", "0.001,7,1", "0.002,7,2", "0.003,8,3"});
}

TEST_CASE("an evenly spaced table holds the newest values, begins where it is asked to and ends with the record") {
  WrittenRecord record;
  write_knee(record);
  const RecordOutline outline = record.outline();
  const std::vector<std::string> lines = all_of(csv(outline, {"knee.torque_Nm", "slow.*"}, {}, 25 * ms));
  CHECK(lines == std::vector<std::string>{"time_s,knee.torque_Nm [Nm],slow.temperature_C [C]", "0,-0,20",
                                          "0.025,-25,20.2", "0.05,-50,20.5", "0.075,-75,20.7"});
  const std::vector<std::string> part = all_of(csv(outline, {"slow.*"}, {35 * ms, 62 * ms}, 10 * ms));
  CHECK(part == std::vector<std::string>{"time_s,slow.temperature_C [C]", "0.035,20.3", "0.045,20.4", "0.055,20.5"});
  CHECK(all_of(csv(outline, {"slow.*"}, {35 * ms, 62 * ms})).size() == 1 + 3);
}

TEST_CASE("signals are chosen by name, pattern or front part, each once, and the nearest is named for a wrong one") {
  WrittenRecord record;
  write_knee(record);
  const RecordOutline outline = record.outline();
  const auto names = [&](const std::vector<std::string>& patterns) {
    std::vector<std::string> chosen;
    for (const ChosenSignal& signal : choose_signals(outline, patterns)) chosen.push_back(signal.info.name);
    return chosen;
  };
  CHECK(names({"slow", "*rad", "slow.*"}) == std::vector<std::string>{"slow.temperature_C", "knee.angle_rad"});
  CHECK(names({}).size() == 3);
  CHECK_THROWS_WITH_AS(names({"knee.angel_rad"}), doctest::Contains("did you mean 'knee.angle_rad'?"), InputError);
  CHECK_THROWS_WITH_AS(choose_topics(outline, {"kne"}), doctest::Contains("did you mean '/knee'?"), InputError);
}

TEST_CASE("the outline counts messages, rates and events, and says where a record was cut short") {
  WrittenRecord record;
  write_knee(record);
  const RecordOutline whole = record.outline();
  CHECK(whole.complete);
  CHECK(whole.robot() == "leg");
  CHECK(whole.fact("run", "seed") == "3");
  CHECK(whole.rows == 100);
  CHECK(whole.topics[0].rate_hz() == doctest::Approx(1000));
  CHECK(whole.topics[1].rate_hz() == doctest::Approx(100));
  CHECK(whole.transitions.size() == 2);
  CHECK(whole.faults.size() == 1);
  CHECK(whole.log.size() == 1);
  CHECK(whole.last_ns == 99 * ms);
  CHECK(whole.packing.unpacked_bytes > whole.packing.packed_bytes);
  record.cut_short();
  const RecordOutline part = record.outline();
  CHECK_FALSE(part.complete);
  CHECK(part.problem.find("byte ") != std::string::npos);
  CHECK(part.rows < 100);
  CHECK(part.rows > 0);
}

}  // namespace record_text_test
