#include "record_writer.h"

#include <numeric>
#include <utility>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "viewer_messages.h"

namespace kadans {
namespace {

constexpr std::uint64_t parameters_every_ticks = 10;

}  // namespace

RecordWriter::RecordWriter(const SignalTable& signals, const RecorderSettings& settings)
    : signals_(signals), settings_(settings), viewers_(signals, settings.subjects), file_(settings.file) {
  for (SignalTopic& topic : signal_topics(signals, settings_.precision, settings_.every_ticks)) {
    stride_ = std::gcd(stride_, std::uint64_t{topic.every_ticks});
    topics_.push_back({.signals = std::move(topic)});
  }
  if (!viewers_.channels().empty()) stride_ = std::gcd(stride_, std::uint64_t{settings_.viewer_every_ticks});
}

std::uint16_t RecordWriter::add(const ViewerChannel& channel) {
  const std::uint16_t schema = file_.add_schema(channel.schema_name, channel.schema_encoding, channel.schema);
  return file_.add_channel(channel.topic, channel.encoding, schema);
}

bool RecordWriter::open(const std::string& path) {
  if (!file_.open(path)) return false;
  for (Topic& topic : topics_) {
    const std::uint16_t schema = file_.add_schema(topic.signals.type, "ros2msg", topic.signals.definition);
    topic.channel = file_.add_channel(topic.signals.topic, "cdr", schema,
                                      {{"signals", topic.signals.description},
                                       {"every_ticks", std::to_string(topic.signals.every_ticks)},
                                       {"standstill_ticks", std::to_string(settings_.standstill_ticks)}});
  }
  for (const ViewerChannel& viewer : viewers_.channels()) viewer_channels_.push_back(add(viewer));
  log_ = add(log_channel);
  transitions_ = add(transitions_channel);
  active_ = add(active_channel);
  emitted_ = add(events_channel);
  faults_ = add(faults_channel);
  timing_ = add(timing_channel);
  parameters_channel_ = add(parameters_channel);
  return true;
}

bool RecordWriter::describe_robot(const std::string& name, const std::string& urdf, std::int64_t time_ns) {
  return file_.attach(name + ".urdf", "application/xml", time_ns, bytes_of(urdf)) && describe_other("", urdf, time_ns);
}

bool RecordWriter::describe_other(const std::string& robot, const std::string& urdf, std::int64_t time_ns) {
  write_robot_description(urdf, message_);
  return file_.write(add(robot_description_channel(robot)), 0, time_ns, message_.bytes());
}

bool RecordWriter::describe_parts(const std::string& description, std::int64_t time_ns) {
  return file_.write(add(description_channel), 0, time_ns, bytes_of(description));
}

bool RecordWriter::row(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  bool written = error().empty();
  for (Topic& topic : topics_) {
    if (tick % topic.signals.every_ticks == 0) written = put(topic, tick, time_ns, row) && written;
  }
  if (tick % settings_.viewer_every_ticks == 0) written = put_viewers(tick, time_ns, row) && written;
  const bool looks = parameters_.empty() || tick % parameters_every_ticks == 0;
  if (looks && settings_.parameters != nullptr) written = put_parameters(time_ns) && written;
  return written;
}

bool RecordWriter::put(Topic& topic, std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  const bool stands = topic.written && is_cdr(topic.payload, topic.signals, row, settings_.precision);
  if (stands && tick - topic.tick < settings_.standstill_ticks) {
    topic.waits = true;
    topic.waiting_tick = tick;
    topic.waiting_ns = time_ns;
    return true;
  }
  bool written = true;
  if (!stands && topic.waits) written = put_last(topic, topic.waiting_tick, topic.waiting_ns);
  topic.waits = false;
  topic.written = true;
  topic.tick = tick;
  topic.payload.resize(cdr_bytes(topic.signals.signals.size(), settings_.precision));
  write_cdr(topic.payload, topic.signals, row, settings_.precision);
  return put_last(topic, tick, time_ns) && written;
}

bool RecordWriter::put_last(const Topic& topic, std::uint64_t tick, std::int64_t time_ns) {
  return file_.write(topic.channel, static_cast<std::uint32_t>(tick), time_ns, topic.payload);
}

bool RecordWriter::put_viewers(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) {
  bool written = true;
  for (std::size_t i = 0; i < viewer_channels_.size(); ++i) {
    viewers_.write(i, time_ns, row, message_);
    written = file_.write(viewer_channels_[i], static_cast<std::uint32_t>(tick), time_ns, message_.bytes()) && written;
  }
  return written;
}

// All of them first, then what changed since.
bool RecordWriter::put_parameters(std::int64_t time_ns) {
  const ParameterTable& table = *settings_.parameters;
  const bool first = parameters_.empty();
  parameters_.resize(table.size());
  nlohmann::ordered_json changed;
  for (ParameterId id = 0; id < table.size(); ++id) {
    const double value = table.newest(id);
    if (!first && value == parameters_[id]) continue;
    parameters_[id] = value;
    changed.push_back({{"name", table.info(id).name}, {"value", value}});
  }
  if (changed.empty()) return true;
  const nlohmann::ordered_json json{{"timestamp", {{"sec", time_ns / ns_per_s}, {"nsec", time_ns % ns_per_s}}},
                                    {"parameters", changed}};
  return file_.write(parameters_channel_, 0, time_ns, bytes_of(json_text(json)));
}

bool RecordWriter::event(const Event& event) {
  const std::uint16_t channel = event.kind == Event::Kind::transition ? transitions_
                                : event.kind == Event::Kind::active   ? active_
                                : event.kind == Event::Kind::emitted  ? emitted_
                                                                      : log_;
  return file_.write(channel, 0, event.transition.time_ns, bytes_of(json_of(event)));
}

bool RecordWriter::fault(const Fault& fault, std::int64_t time_ns) {
  return file_.write(faults_, static_cast<std::uint32_t>(fault.tick), time_ns,
                     bytes_of(json_of(told(fault, settings_.subjects, time_ns))));
}

void RecordWriter::add_inputs(const InputLayout& layout) {
  const std::uint16_t schema = file_.add_schema("kadans.Inputs", "", "");
  TextMap facts = layout.facts();
  for (const std::string& name : signals_.names()) facts["names"] += name + '\n';
  (void)file_.add_metadata(inputs_metadata, facts);
  inputs_ = file_.add_channel(inputs_topic, "", schema);
  behavior_inputs_ = file_.add_channel(behavior_inputs_topic, "", schema);
  if (layout.state_bytes > 0) states_ = file_.add_channel(states_topic, "", schema);
}

bool RecordWriter::inputs(std::span<const std::byte> message, std::int64_t time_ns) {
  return file_.write(inputs_, 0, time_ns, message);
}

bool RecordWriter::behavior_inputs(std::span<const std::byte> message, std::int64_t time_ns) {
  return file_.write(behavior_inputs_, 0, time_ns, message);
}

bool RecordWriter::decision_inputs(std::span<const std::byte> message, std::int64_t time_ns) {
  if (decision_inputs_ == 0)
    decision_inputs_ = file_.add_channel(decision_inputs_topic, "", file_.add_schema("kadans.DecisionInputs", "", ""));
  return file_.write(decision_inputs_, 0, time_ns, message);
}

bool RecordWriter::state(std::span<const std::byte> message, std::int64_t time_ns) {
  return file_.write(states_, 0, time_ns, message);
}

bool RecordWriter::timing(const std::string& json, std::int64_t time_ns) {
  return file_.write(timing_, 0, time_ns, bytes_of(json));
}

// A topic that stands still ends with its last row.
bool RecordWriter::close() {
  for (Topic& topic : topics_) {
    if (!std::exchange(topic.waits, false)) continue;
    topic.tick = topic.waiting_tick;
    (void)put_last(topic, topic.waiting_tick, topic.waiting_ns);
  }
  return file_.close();
}

}  // namespace kadans
