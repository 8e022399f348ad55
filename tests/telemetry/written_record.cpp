#include "written_record.h"

#include <doctest/doctest.h>

namespace kadans {
namespace {

std::int64_t ns(std::uint32_t tick) { return std::int64_t{1'000'000} * tick; }

}  // namespace

WrittenRecord::WrittenRecord(Precision precision) : writer_({.chunk_period_ns = 20'000'000}), precision_(precision) {
  REQUIRE(writer_.open(file_.path()));
  REQUIRE(writer_.add_metadata("run", {{"scenario", "knee.json"}, {"seed", "3"}}));
  REQUIRE(writer_.attach("leg.urdf", "application/xml", 0, bytes_of("<robot name=\"leg\"/>")));
}

std::uint16_t WrittenRecord::rows(const std::vector<std::string>& signals, int every_ticks) {
  const double zero = 0;
  SignalTable table;
  for (const std::string& signal : signals) {
    const std::size_t bar = signal.find('|');
    table.add({signal.substr(0, bar), signal.substr(bar + 1), "Of a test."}, &zero);
  }
  const std::vector<SignalTopic> topics = signal_topics(table, precision_);
  REQUIRE(topics.size() == 1);
  const std::uint16_t schema = writer_.add_schema(topics[0].type, "ros2msg", topics[0].definition);
  return writer_.add_channel(topics[0].topic, "cdr", schema,
                             {{"signals", topics[0].description}, {"every_ticks", std::to_string(every_ticks)}});
}

void WrittenRecord::row(std::uint16_t channel, std::uint32_t tick, std::initializer_list<double> values) {
  std::vector<std::byte> payload(cdr_bytes(values.size(), precision_));
  write_cdr(payload, std::vector<double>(values), precision_);
  REQUIRE(writer_.write(channel, tick, ns(tick), payload));
}

std::uint16_t WrittenRecord::json_channel(const std::string& topic, const std::string& schema) {
  const auto known = json_channels_.find(topic);
  if (known != json_channels_.end()) return known->second;
  return json_channels_[topic] = writer_.add_channel(topic, "json", writer_.add_schema(schema, "jsonschema", "{}"));
}

void WrittenRecord::put(std::uint16_t channel, std::uint32_t tick, const std::string& json) {
  REQUIRE(writer_.write(channel, 0, ns(tick), bytes_of(json)));
}

void WrittenRecord::transition(std::uint32_t tick, const std::string& from, const std::string& to) {
  Event event{.kind = Event::Kind::transition, .transition = {ns(tick), "bend", from, to, "told"}};
  put(json_channel("/transitions", "kadans.Transition"), tick, json_of(event));
}

void WrittenRecord::fault(std::uint32_t tick, const std::string& name, const std::string& joint) {
  put(json_channel("/faults", "kadans.Fault"), tick,
      R"({"timestamp":{"sec":0,"nsec":0},"name":")" + name + R"(","joint":")" + joint + R"(","value":2,"limit":1})");
}

void WrittenRecord::say(std::uint32_t tick, const std::string& text) {
  Event event{.kind = Event::Kind::message, .transition = {ns(tick), "bend", "", "", ""}};
  event.text = text;
  put(json_channel("/log", "foxglove.Log"), tick, json_of(event));
}

void WrittenRecord::describe(std::uint32_t tick, const std::string& json) {
  put(json_channel("/description", "kadans.Description"), tick, json);
}

const std::string& WrittenRecord::path() {
  if (writer_.is_open()) REQUIRE(writer_.close());
  return file_.path();
}

void WrittenRecord::cut_short() {
  path();
  std::vector<std::byte> all = file_.bytes();
  all.resize(all.size() / 2);
  file_.write(all);
}

void write_knee(WrittenRecord& record) {
  const std::uint16_t knee = record.rows({"knee.angle_rad|rad", "knee.torque_Nm|Nm"});
  const std::uint16_t slow = record.rows({"slow.temperature_C|C"}, 10);
  record.describe(0, R"({"robot":{"name":"leg"}})");
  for (std::uint32_t tick = 0; tick < 100; ++tick) {
    if (tick == 20) record.transition(tick, "up", "down");
    if (tick == 60) record.transition(tick, "down", "up");
    if (tick == 50) record.fault(tick, "motor_hot", "knee");
    if (tick == 70) record.say(tick, "so \"far\"");
    record.row(knee, tick, {1e-3 * tick, -1.0 * tick});
    if (tick % 10 == 0) record.row(slow, tick, {20 + 1e-2 * tick});
  }
}

}  // namespace kadans
