
#include "viewer_messages.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "kadans/signal/frames.h"
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

// {"x":1,"y":2.5,"z":null}, and "w"
void put_json_members(std::string& text, std::initializer_list<double> values) {
  char name = 'x';
  for (const double value : values) {
    text += name == 'x' ? '{' : ',';
    text += std::string{'"', name, '"', ':'};
    std::array<char, 32> digits{};
    if (std::isfinite(value))
      text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
    else
      text += "null";
    name = name == 'z' ? 'w' : static_cast<char>(name + 1);
  }
  text += '}';
}

double value_of(std::span<const double> row, std::optional<SignalId> signal) noexcept {
  return signal ? row[*signal] : 0;
}

ViewerChannel of_ros(const std::string& topic, const char* type, const std::string& definition) {
  return {.topic = topic, .encoding = "cdr", .schema_name = type, .schema_encoding = "ros2msg", .schema = definition};
}

// "/left" for the robot "left", "" for the first.
std::string topics_of(const std::string& robot) { return robot.empty() ? "" : "/" + robot; }

constexpr const char* time_schema = R"(
    "timestamp": { "type": "object", "title": "time", "description": "Time of the run", "properties": {
      "sec": { "type": "integer", "minimum": 0 },
      "nsec": { "type": "integer", "minimum": 0, "maximum": 999999999 } } },)";

// Of messages that tell their time, and these properties.
ViewerChannel told_channel(const std::string& topic, const std::string& name, const std::string& doc,
                           const std::string& properties) {
  const std::string head =
      "{\n  \"title\": \"" + name + "\", \"type\": \"object\",\n  \"description\": \"" + doc + "\",\n";
  return json_channel(topic, name, head + "  \"properties\": {" + time_schema + properties + "\n  }\n}");
}

}  // namespace

ViewerChannel json_channel(const std::string& topic, const std::string& schema_name, const std::string& schema) {
  return {.topic = topic,
          .encoding = "json",
          .schema_name = schema_name,
          .schema_encoding = "jsonschema",
          .schema = schema};
}

const ViewerChannel log_channel = told_channel("/log", "foxglove.Log", "A line of text for people", R"(
    "level": { "title": "foxglove.LogLevel", "description": "How much it matters", "oneOf": [
      { "title": "UNKNOWN", "const": 0 }, { "title": "DEBUG", "const": 1 }, { "title": "INFO", "const": 2 },
      { "title": "WARNING", "const": 3 }, { "title": "ERROR", "const": 4 }, { "title": "FATAL", "const": 5 } ] },
    "message": { "type": "string", "description": "What is said" },
    "name": { "type": "string", "description": "The behavior, or the part of the runtime, that says it" },
    "file": { "type": "string", "description": "File it came from, or empty" },
    "line": { "type": "integer", "minimum": 0, "description": "Line in that file" })");

const ViewerChannel transitions_channel =
    told_channel("/transitions", "kadans.Transition", "A change of state of a behavior", R"(
    "behavior": { "type": "string" },
    "from": { "type": "string", "description": "Path of the state that was left, empty on entry" },
    "to": { "type": "string", "description": "Path of the state that was entered" },
    "why": { "type": "string" })");

const ViewerChannel active_channel =
    told_channel("/active", "kadans.Active", "All innermost active states of a behavior, told when they change", R"(
    "behavior": { "type": "string" },
    "states": { "type": "array", "items": { "type": "string" },
      "description": "Their paths, in document order; none: the behavior is over" })");

const ViewerChannel events_channel =
    told_channel("/events", "kadans.Event", "An event from outside that behaviors got", R"(
    "tick": { "type": "integer", "description": "Tick of the control engine" },
    "event": { "type": "string" }, "data": { "type": "object" },
    "who": { "type": "string", "description": "Who sent it" },
    "ordered": { "type": "boolean", "description": "Given while the run went on: a replay takes it from here" })");

const ViewerChannel faults_channel = told_channel("/faults", "kadans.Fault", "A fault that the safety layer found", R"(
    "name": { "type": "string" }, "joint": { "type": "string" },
    "words": { "type": "string", "description": "In place of value and limit" },
    "value": { "type": "number" }, "limit": { "type": "number" })");

const ViewerChannel parameters_channel =
    told_channel("/parameters", "kadans.Parameters", "All parameters at the start, then those that changed", R"(
    "parameters": { "type": "array", "items": { "type": "object",
      "properties": { "name": { "type": "string" }, "value": { "type": "number" } } } })");

const ViewerChannel timing_channel =
    json_channel("/timing", "kadans.Timing", R"({"title": "kadans.Timing", "type": "object"})");

const ViewerChannel description_channel = json_channel("/description", "kadans.Description", R"({
  "title": "kadans.Description", "type": "object",
  "description": "Robot, control sets, parameters, world and charts of a run",
  "properties": {
    "robot": { "type": "object" }, "sets": { "type": "array" }, "objects": { "type": "array" },
    "parameters": { "type": "array" }, "world": { "type": "array" }, "ground": { "type": "object" },
    "payloads": { "type": "array" }, "behaviors": { "type": "array" }
  }
})");

ToldFault told(const Fault& fault, const ViewerSubjects& subjects, std::int64_t time_ns) {
  const ViewerSubjects& of = fault.robot == 0 ? subjects : subjects.others.at(fault.robot - 1U);
  return told(fault, fault.joint < of.joints.size() ? of.joints[fault.joint] : "", time_ns, of.robot);
}

ViewerMessages::ViewerMessages(const SignalTable& signals, const ViewerSubjects& subjects) {
  if (subjects.empty()) return;
  add(signals, subjects);
  for (const ViewerSubjects& other : subjects.others) add(signals, other);
}

void ViewerMessages::add(const SignalTable& signals, const ViewerSubjects& subjects) {
  const std::string topics = topics_of(subjects.robot), name = subjects.robot.empty() ? "" : subjects.robot + ".";
  const auto find = [&](const std::string& signal) { return signals.find(name + signal); };
  const auto either = [&](const char* first, const char* second) {
    const auto found = find(first);
    return found ? found : find(second);
  };
  const std::size_t number = robots_.size();
  Robot robot{.subjects = subjects, .frames = topics.empty() ? "" : subjects.robot + "/", .joints = {}, .feet = {}};
  const auto offer = [&](Content content, ViewerChannel channel) {
    contents_.push_back(content);
    channels_.push_back(std::move(channel));
  };
  offer({Content::Kind::joint_states, number}, of_ros(topics + "/joint_states", "sensor_msgs/msg/JointState",
                                                      joint_state_definition + std::string(header_definition)));
  if (number == 0) offer({Content::Kind::bases}, json_channel("/tf", "foxglove.FrameTransforms", transforms_schema));
  for (const std::string& joint : subjects.joints) {
    const std::string of = "joint." + joint;
    robot.joints.push_back({find(of + ".position_rad"), find(of + ".velocity_rad_s"), find(of + ".effort_Nm")});
  }
  for (const std::string& foot : subjects.feet) {
    offer({Content::Kind::wrench, number, robot.feet.size()},
          of_ros(topics + "/wrench/" + foot, "geometry_msgs/msg/WrenchStamped",
                 wrench_definition + std::string(header_definition)));
    const std::string of = "foot." + foot;
    robot.feet.push_back({find(of + ".force_N"), find(of + ".cop_x_m"), find(of + ".cop_y_m")});
  }
  // As the model knows it where there is one, else as it is estimated.
  robot.base = {.roll = find("base.roll_rad"),
                .pitch = find("base.pitch_rad"),
                .yaw = either("plant.base.yaw_rad", "base.yaw_rad"),
                .x = find("plant.base.x_m"),
                .y = find("plant.base.y_m"),
                .z = either("plant.base.height_m", "base.height_m")};
  robot.named = "},\"parent_frame_id\":\"world\",\"child_frame_id\":" + json_text(Json(robot.frames + subjects.base)) +
                ",\"translation\":";
  robots_.push_back(std::move(robot));
}

void ViewerMessages::write_joint_states(const Robot& robot, std::int64_t time_ns, std::span<const double> row,
                                        ByteWriter& to) {
  put_header(to, time_ns, "");
  align(to, 4);
  to.put(static_cast<std::uint32_t>(robot.joints.size()));
  for (const std::string& joint : robot.subjects.joints) put_cdr_string(to, joint);
  for (const auto member : {&Joint::position, &Joint::velocity, &Joint::effort}) {
    values_.clear();
    for (const Joint& joint : robot.joints) values_.push_back(value_of(row, joint.*member));
    put_cdr_doubles(to, values_);
  }
}

// Fifty times a second, so it is written as text at once.
void ViewerMessages::write_bases(std::int64_t time_ns, std::span<const double> row, ByteWriter& to) {
  text_ = "{\"transforms\":[";
  for (const Robot& robot : robots_) {
    const Base& base = robot.base;
    const double roll = value_of(row, base.roll) / 2, pitch = value_of(row, base.pitch) / 2;
    const double yaw = value_of(row, base.yaw) / 2;
    const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch);
    const double cy = std::cos(yaw), sy = std::sin(yaw);
    text_ += &robot == robots_.data() ? "{\"timestamp\":{\"sec\":" : ",{\"timestamp\":{\"sec\":";
    text_ += std::to_string(time_ns / ns_per_s) + ",\"nsec\":" + std::to_string(time_ns % ns_per_s) + robot.named;
    put_json_members(text_, {value_of(row, base.x), value_of(row, base.y), value_of(row, base.z)});
    text_ += ",\"rotation\":";
    put_json_members(text_, {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                             cr * cp * cy + sr * sp * sy});
    text_ += '}';
  }
  text_ += "]}";
  to.put(bytes_of(text_));
}

void ViewerMessages::write(std::size_t channel, std::int64_t time_ns, std::span<const double> row, ByteWriter& to) {
  to.clear();
  const Content& content = contents_[channel];
  if (content.kind == Content::Kind::bases) return write_bases(time_ns, row, to);
  const Robot& robot = robots_[content.robot];
  if (content.kind == Content::Kind::joint_states) return write_joint_states(robot, time_ns, row, to);
  // The force on the sole stands up in the foot's frame, at the centre of pressure.
  const Foot& of = robot.feet[content.foot];
  const double force_N = value_of(row, of.force);
  put_header(to, time_ns, robot.frames + robot.subjects.feet[content.foot]);
  align(to, 8);
  for (const double value :
       {0.0, 0.0, force_N, value_of(row, of.cop_y) * force_N, -value_of(row, of.cop_x) * force_N, 0.0})
    to.put(value);
}

ViewerChannel robot_description_channel(const std::string& robot) {
  return of_ros(topics_of(robot) + "/robot_description", "std_msgs/msg/String", "string data\n");
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
