#include "kadans/remote/live_channels.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "kadans/signal/byte_order.h"
#include "kadans/telemetry/recorder.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t ns_per_s = 1'000'000'000;
constexpr double limit_max_us = 20'000, limit_step = 1.0905077326652577;  // 8 an octave

// With the messages that it is made of, as tools of ROS 2 write them.
constexpr const char* joint_state_definition = R"(std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
)";

constexpr const char* transforms_schema = R"({
  "title": "foxglove.FrameTransforms", "type": "object",
  "properties": { "transforms": { "type": "array", "items": {
    "title": "foxglove.FrameTransform", "type": "object",
    "properties": {
      "timestamp": { "type": "object", "title": "time",
        "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } } },
      "parent_frame_id": { "type": "string" },
      "child_frame_id": { "type": "string" },
      "translation": { "title": "foxglove.Vector3", "type": "object",
        "properties": { "x": { "type": "number" }, "y": { "type": "number" }, "z": { "type": "number" } } },
      "rotation": { "title": "foxglove.Quaternion", "type": "object",
        "properties": { "x": { "type": "number" }, "y": { "type": "number" }, "z": { "type": "number" },
                        "w": { "type": "number" } } } } } } }
})";

constexpr const char* fault_schema = R"({
  "title": "kadans.Fault", "type": "object",
  "properties": { "timestamp": { "type": "object", "title": "time",
      "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } } },
    "name": { "type": "string" }, "joint": { "type": "string" },
    "value": { "type": "number" }, "limit": { "type": "number" } }
})";

Json stamp(std::int64_t time_ns) { return {{"sec", time_ns / ns_per_s}, {"nsec", time_ns % ns_per_s}}; }

// CDR: numbers stand on multiples of their size, counted behind the head of four bytes.
void align(ByteWriter& to, std::size_t size) {
  while ((to.size() - cdr_head_bytes) % size != 0) to.put(std::uint8_t{0});
}

void put_cdr_string(ByteWriter& to, const std::string& text) {
  align(to, 4);
  to.put(static_cast<std::uint32_t>(text.size() + 1));
  to.put(bytes_of(text));
  to.put(std::uint8_t{0});
}

void put_cdr_doubles(ByteWriter& to, std::span<const double> values) {
  align(to, 4);
  to.put(static_cast<std::uint32_t>(values.size()));
  align(to, 8);
  for (const double value : values) to.put(value);
}

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

const LiveMessage* LiveChannel::next(std::uint64_t& seen) const noexcept {
  const std::uint64_t oldest = count - messages.size();
  if (seen >= count) return nullptr;
  seen = std::max(seen, oldest);
  return &messages[static_cast<std::size_t>(seen++ - oldest)];
}

void LiveChannel::put(std::uint64_t time_ns, std::span<const std::byte> payload) {
  if (!messages.empty() && (!events || messages.size() == events_kept)) messages.pop_front();
  messages.push_back({time_ns, copy_of(payload)});
  ++count;
}

LiveChannels::LiveChannels(const Instance& instance, const RobotTexts& texts)
    : catalog_(instance.catalog()),
      topics_(signal_topics(catalog_.signals, Precision::full)),
      description_(texts.description) {
  for (const SignalTopic& topic : topics_) {
    signals_["signals" + topic.topic] = topic.description;
    add({.topic = topic.topic,
         .encoding = "cdr",
         .schema_name = topic.type,
         .schema_encoding = "ros2msg",
         .schema = topic.definition});
  }
  joint_states_ = add({.topic = "/joint_states",
                       .encoding = "cdr",
                       .schema_name = "sensor_msgs/msg/JointState",
                       .schema_encoding = "ros2msg",
                       .schema = joint_state_definition});
  transforms_ = add_json("/tf", "foxglove.FrameTransforms", transforms_schema, false);
  log_ = add_json("/log", "foxglove.Log", log_schema, true);
  transitions_ = add_json("/transitions", "kadans.Transition", transition_schema, true);
  faults_ = add_json("/faults", "kadans.Fault", fault_schema, true);
  timing_ = add_json("/timing", "kadans.Timing", R"({"title": "kadans.Timing", "type": "object"})", false);
  described_ = add_json("/description", "kadans.Description", description_schema, false);
  put_json(described_, 0, texts.description);
  const std::size_t robot = add({.topic = "/robot_description",
                                 .encoding = "cdr",
                                 .schema_name = "std_msgs/msg/String",
                                 .schema_encoding = "ros2msg",
                                 .schema = "string data\n"});
  ByteWriter urdf;
  urdf.put(std::uint32_t{0x0100});
  put_cdr_string(urdf, texts.urdf);
  channels_[robot].put(0, urdf.bytes());
  base_ = catalog_.model->links.front().name;
  for (const Joint& joint : catalog_.model->joints) {
    const auto of = [&](const char* what) { return catalog_.signals.find("joint." + joint.name + what); };
    joints_.push_back({of(".position_rad"), of(".velocity_rad_s"), of(".effort_Nm")});
  }
}

std::size_t LiveChannels::add(LiveChannel channel) {
  channels_.push_back(std::move(channel));
  return channels_.size() - 1;
}

std::size_t LiveChannels::add_json(const std::string& topic, const std::string& schema, const char* text, bool events) {
  return add({.topic = topic,
              .encoding = "json",
              .schema_name = schema,
              .schema_encoding = "jsonschema",
              .schema = text,
              .events = events});
}

void LiveChannels::put_json(std::size_t channel, std::int64_t time_ns, const std::string& json) {
  channels_[channel].put(static_cast<std::uint64_t>(time_ns), bytes_of(json));
}

void LiveChannels::take(const LatestRow::View& row) {
  if (row.values.empty()) return;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    values_.clear();
    for (const SignalId id : topics_[i].signals) values_.push_back(row.values[id]);
    payload_.resize(cdr_bytes(values_.size(), Precision::full));
    write_cdr(payload_, values_, Precision::full);
    channels_[i].put(static_cast<std::uint64_t>(row.time_ns), payload_);
  }
  put_joint_states(row);
  put_base(row);
}

void LiveChannels::put_joint_states(const LatestRow::View& row) {
  ByteWriter to;
  to.put(std::uint32_t{0x0100});
  to.put(static_cast<std::uint32_t>(row.time_ns / ns_per_s));
  to.put(static_cast<std::uint32_t>(row.time_ns % ns_per_s));
  put_cdr_string(to, "");
  align(to, 4);
  to.put(static_cast<std::uint32_t>(joints_.size()));
  for (const Joint& joint : catalog_.model->joints) put_cdr_string(to, joint.name);
  for (const auto member : {&JointSignals::position, &JointSignals::velocity, &JointSignals::effort}) {
    values_.clear();
    for (const JointSignals& joint : joints_) {
      const std::optional<SignalId> id = joint.*member;
      values_.push_back(id ? row.values[*id] : 0);
    }
    put_cdr_doubles(to, values_);
  }
  channels_[joint_states_].put(static_cast<std::uint64_t>(row.time_ns), to.bytes());
}

double LiveChannels::value(const LatestRow::View& row, const std::string& signal, double otherwise) const {
  const auto id = catalog_.signals.find(signal);
  return id ? row.values[*id] : otherwise;
}

// As the model knows it where there is one, else as it is estimated.
void LiveChannels::put_base(const LatestRow::View& row) {
  const double roll = value(row, "base.roll_rad", 0) / 2, pitch = value(row, "base.pitch_rad", 0) / 2;
  const double yaw = value(row, "plant.base.yaw_rad", value(row, "base.yaw_rad", 0)) / 2;
  const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch);
  const double cy = std::cos(yaw), sy = std::sin(yaw);
  const Json translation{{"x", value(row, "plant.base.x_m", 0)},
                         {"y", value(row, "plant.base.y_m", 0)},
                         {"z", value(row, "plant.base.height_m", value(row, "base.height_m", 0))}};
  const Json rotation{{"x", sr * cp * cy - cr * sp * sy},
                      {"y", cr * sp * cy + sr * cp * sy},
                      {"z", cr * cp * sy - sr * sp * cy},
                      {"w", cr * cp * cy + sr * sp * sy}};
  const Json transform{{"timestamp", stamp(row.time_ns)},
                       {"parent_frame_id", "world"},
                       {"child_frame_id", base_},
                       {"translation", translation},
                       {"rotation", rotation}};
  put_json(transforms_, row.time_ns, Json{{"transforms", Json::array({transform})}}.dump());
}

void LiveChannels::take(const Event& event) {
  put_json(event.kind == Event::Kind::transition ? transitions_ : log_, event.transition.time_ns, json_of(event));
}

void LiveChannels::take(const Fault& fault, std::int64_t time_ns) {
  const auto& joints = catalog_.model->joints;
  const std::string joint = fault.joint < joints.size() ? joints[fault.joint].name : "";
  const Json json{{"timestamp", stamp(time_ns)},
                  {"name", name(fault.code)},
                  {"joint", joint},
                  {"value", fault.value},
                  {"limit", fault.limit}};
  put_json(faults_, time_ns, json.dump());
}

void LiveChannels::take_behaviors(const std::string& json) {
  Json description = Json::parse(description_);
  description["behaviors"] = Json::parse(json);
  description_ = description.dump(-1, ' ', false, Json::error_handler_t::replace);
  put_json(described_, 0, description_);
}

void LiveChannels::take_timing(const std::string& json, std::int64_t time_ns) { put_json(timing_, time_ns, json); }

std::string timing_json(const std::vector<TimingSource>& sources) {
  constexpr int bins = 48;
  Json json = Json::object();
  for (const TimingSource& source : sources) {
    const TickStatistics& s = *source.statistics;
    if (s.count() == 0) continue;
    const double low = static_cast<double>(s.min_ns());
    const double high = std::max(low + bins, s.percentile_ns(0.9999));
    Json counts = Json::array();
    std::uint64_t below = 0;
    for (int i = 1; i <= bins; ++i) {
      const std::uint64_t until =
          i == bins ? s.count() : s.count_until(std::llround(low + (high - low) * static_cast<double>(i) / bins));
      counts.push_back(until > below ? until - below : 0);
      below = std::max(below, until);
    }
    Json limits = Json::array(), within = Json::array();
    for (double limit_us = 1; limit_us < limit_max_us; limit_us *= limit_step) {
      limits.push_back(std::round(limit_us * 10) / 10);
      within.push_back(s.count_until(std::llround(limit_us * 1e3)));
    }
    json[source.name] = {{"unit", "us"},
                         {"low", low * 1e-3},
                         {"high", high * 1e-3},
                         {"counts", counts},
                         {"median", s.percentile_ns(0.5) * 1e-3},
                         {"p99", s.percentile_ns(0.99) * 1e-3},
                         {"max", static_cast<double>(s.max_ns()) * 1e-3},
                         {"count", s.count()},
                         {"limits", limits},
                         {"within", within}};
  }
  return json.dump();
}

}  // namespace kadans
