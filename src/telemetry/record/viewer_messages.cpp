
#include "viewer_messages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "signal_topics.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t cdr_head = 0x0100;  // little-endian

// With the messages that they are made of, as tools of ROS 2 write them.
constexpr const char* header_definition =
    R"(================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
)";

constexpr const char* joint_state_definition = R"(std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
)";

constexpr const char* wrench_definition = R"(std_msgs/Header header
geometry_msgs/Wrench wrench
================================================================================
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
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

void put_header(ByteWriter& to, std::int64_t time_ns, const std::string& frame) {
  to.put(cdr_head);
  to.put(static_cast<std::uint32_t>(time_ns / ns_per_s));
  to.put(static_cast<std::uint32_t>(time_ns % ns_per_s));
  put_cdr_string(to, frame);
}

double value_of(std::span<const double> row, std::optional<SignalId> signal) noexcept {
  return signal ? row[*signal] : 0;
}

ViewerChannel of_ros(const std::string& topic, const char* type, const std::string& definition) {
  return {.topic = topic, .encoding = "cdr", .schema_name = type, .schema_encoding = "ros2msg", .schema = definition};
}

}  // namespace

ViewerMessages::ViewerMessages(const SignalTable& signals, ViewerSubjects subjects) : subjects_(std::move(subjects)) {
  if (subjects_.empty()) return;
  find_signals(signals);
  channels_.push_back(
      of_ros("/joint_states", "sensor_msgs/msg/JointState", joint_state_definition + std::string(header_definition)));
  channels_.push_back({.topic = "/tf",
                       .encoding = "json",
                       .schema_name = "foxglove.FrameTransforms",
                       .schema_encoding = "jsonschema",
                       .schema = transforms_schema});
  for (const std::string& foot : subjects_.feet) {
    channels_.push_back(of_ros("/wrench/" + foot, "geometry_msgs/msg/WrenchStamped",
                               wrench_definition + std::string(header_definition)));
  }
}

void ViewerMessages::find_signals(const SignalTable& signals) {
  const auto either = [&](const char* first, const char* second) {
    const auto found = signals.find(first);
    return found ? found : signals.find(second);
  };
  for (const std::string& joint : subjects_.joints) {
    const std::string of = "joint." + joint;
    joints_.push_back(
        {signals.find(of + ".position_rad"), signals.find(of + ".velocity_rad_s"), signals.find(of + ".effort_Nm")});
  }
  for (const std::string& foot : subjects_.feet) {
    const std::string of = "foot." + foot;
    feet_.push_back({signals.find(of + ".force_N"), signals.find(of + ".cop_x_m"), signals.find(of + ".cop_y_m")});
  }
  // As the model knows it where there is one, else as it is estimated.
  base_ = {.roll = signals.find("base.roll_rad"),
           .pitch = signals.find("base.pitch_rad"),
           .yaw = either("plant.base.yaw_rad", "base.yaw_rad"),
           .x = signals.find("plant.base.x_m"),
           .y = signals.find("plant.base.y_m"),
           .z = either("plant.base.height_m", "base.height_m")};
}

void ViewerMessages::write(std::size_t channel, std::int64_t time_ns, std::span<const double> row, ByteWriter& to) {
  to.clear();
  if (channel == 0) return write_joint_states(time_ns, row, to);
  if (channel == 1) return write_base(time_ns, row, to);
  write_wrench(channel - 2, time_ns, row, to);
}

void ViewerMessages::write_joint_states(std::int64_t time_ns, std::span<const double> row, ByteWriter& to) {
  put_header(to, time_ns, "");
  align(to, 4);
  to.put(static_cast<std::uint32_t>(joints_.size()));
  for (const std::string& joint : subjects_.joints) put_cdr_string(to, joint);
  for (const auto member : {&Joint::position, &Joint::velocity, &Joint::effort}) {
    values_.clear();
    for (const Joint& joint : joints_) values_.push_back(value_of(row, joint.*member));
    put_cdr_doubles(to, values_);
  }
}

void ViewerMessages::write_base(std::int64_t time_ns, std::span<const double> row, ByteWriter& to) const {
  const double roll = value_of(row, base_.roll) / 2, pitch = value_of(row, base_.pitch) / 2;
  const double yaw = value_of(row, base_.yaw) / 2;
  const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch);
  const double cy = std::cos(yaw), sy = std::sin(yaw);
  const Json translation{{"x", value_of(row, base_.x)}, {"y", value_of(row, base_.y)}, {"z", value_of(row, base_.z)}};
  const Json rotation{{"x", sr * cp * cy - cr * sp * sy},
                      {"y", cr * sp * cy + sr * cp * sy},
                      {"z", cr * cp * sy - sr * sp * cy},
                      {"w", cr * cp * cy + sr * sp * sy}};
  const Json transform{{"timestamp", {{"sec", time_ns / ns_per_s}, {"nsec", time_ns % ns_per_s}}},
                       {"parent_frame_id", "world"},
                       {"child_frame_id", subjects_.base},
                       {"translation", translation},
                       {"rotation", rotation}};
  to.put(bytes_of(json_text(Json{{"transforms", Json::array({transform})}})));
}

// The force on the sole stands up in the foot's frame, at the centre of pressure.
void ViewerMessages::write_wrench(std::size_t foot, std::int64_t time_ns, std::span<const double> row,
                                  ByteWriter& to) const {
  const Foot& of = feet_[foot];
  const double force_N = value_of(row, of.force);
  put_header(to, time_ns, subjects_.feet[foot]);
  align(to, 8);
  for (const double value :
       {0.0, 0.0, force_N, value_of(row, of.cop_y) * force_N, -value_of(row, of.cop_x) * force_N, 0.0})
    to.put(value);
}

ViewerChannel robot_description_channel() {
  return of_ros("/robot_description", "std_msgs/msg/String", "string data\n");
}

void write_robot_description(const std::string& urdf, ByteWriter& to) {
  to.clear();
  to.put(cdr_head);
  put_cdr_string(to, urdf);
}

namespace {

constexpr double limit_max_us = 20'000, limit_step = 1.0905077326652577;  // 8 an octave

}  // namespace

std::string timing_json(const std::vector<TimingSource>& sources) {
  constexpr int bins = 48;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const TimingSource& source : sources) {
    const TickStatistics& s = *source.statistics;
    if (s.count() == 0) continue;
    const double low = static_cast<double>(s.min_ns());
    const double high = std::max(low + bins, s.percentile_ns(0.9999));
    nlohmann::ordered_json counts = nlohmann::ordered_json::array();
    std::uint64_t below = 0;
    for (int i = 1; i <= bins; ++i) {
      const std::uint64_t until =
          i == bins ? s.count() : s.count_until(std::llround(low + (high - low) * static_cast<double>(i) / bins));
      counts.push_back(until > below ? until - below : 0);
      below = std::max(below, until);
    }
    nlohmann::ordered_json limits = nlohmann::ordered_json::array(), within = nlohmann::ordered_json::array();
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
  return json_text(json);
}

}  // namespace kadans
