#include "kadans/telemetry/recorder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "kadans/signal/nearest_name.h"

namespace kadans {

const char* const description_schema = R"({
  "title": "kadans.Description",
  "description": "Robot, control sets, parameters and charts of a run",
  "type": "object",
  "properties": {
    "robot": { "type": "object" },
    "sets": { "type": "array" },
    "objects": { "type": "array" },
    "parameters": { "type": "array" },
    "behaviors": { "type": "array" }
  }
})";

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

Recorder::Recorder(const SignalTable& signals, const RecorderSettings& settings)
    : signal_count_(signals.size()),
      precision_(settings.precision),
      ring_(std::make_unique<Rows>()),
      file_settings_(settings.file),
      file_(std::make_unique<McapWriter>(settings.file)) {
  if (head_size + signal_count_ > Rows::capacity()) throw std::invalid_argument("too many signals for the record");
  choose_topics(signals, settings);
}

void Recorder::choose_topics(const SignalTable& signals, const RecorderSettings& settings) {
  std::vector<std::string> names;
  for (SignalTopic& topic : signal_topics(signals, precision_)) {
    const std::string& first = signals.info(topic.signals.front()).name;
    names.push_back(first.substr(0, first.find('.')));
    topics_.push_back({.signals = std::move(topic), .every_ticks = settings.every_ticks});
  }
  for (const RecorderSettings::Topic& chosen : settings.topics) {
    const auto found = std::ranges::find(names, chosen.name);
    if (found == names.end()) {
      throw std::invalid_argument("no signals are called '" + chosen.name + "'" + did_you_mean(chosen.name, names));
    }
    topics_[static_cast<std::size_t>(found - names.begin())].every_ticks = chosen.every_ticks;
  }
  std::erase_if(topics_, [](const Topic& topic) { return topic.every_ticks == 0; });
  for (const Topic& topic : topics_) stride_ = std::gcd(stride_, std::uint64_t{topic.every_ticks});
}

bool Recorder::open(const std::string& path) {
  if (opened_) start_anew();
  opened_ = true;
  if (!file_->open(path)) return false;
  for (Topic& topic : topics_) {
    const std::uint16_t schema = file_->add_schema(topic.signals.type, "ros2msg", topic.signals.definition);
    topic.channel = file_->add_channel(
        topic.signals.topic, "cdr", schema,
        {{"signals", topic.signals.description}, {"every_ticks", std::to_string(topic.every_ticks)}});
  }
  log_channel_ = file_->add_channel("/log", "json", file_->add_schema("foxglove.Log", "jsonschema", log_schema));
  transition_channel_ = file_->add_channel("/transitions", "json",
                                           file_->add_schema("kadans.Transition", "jsonschema", transition_schema));
  return true;
}

// What came since the last file was closed belongs to none.
void Recorder::start_anew() {
  file_ = std::make_unique<McapWriter>(file_settings_);
  ring_->drop(ring_->size());
  while (events_.pop(end_of_time_ns, event_)) {
  }
  rows_ = lost_ = 0;
  last_time_ns_ = 0;
  dropped_.store(0, std::memory_order_relaxed);
  reported_drops_ = dropped_events();
}

bool Recorder::describe_run(const RunInputs& inputs) { return write_inputs(*file_, inputs); }

bool Recorder::describe(const std::string& name, const TextMap& facts) { return file_->add_metadata(name, facts); }

bool Recorder::describe_robot(const std::string& name, const std::string& urdf, std::int64_t time_ns) {
  if (!file_->attach(name + ".urdf", "application/xml", time_ns, bytes_of(urdf))) return false;
  const std::uint16_t channel = file_->add_channel(
      "/robot_description", "cdr", file_->add_schema("std_msgs/msg/String", "ros2msg", "string data\n"));
  ByteWriter payload;  // the CDR head, then the string with its closing zero
  payload.put(std::uint32_t{0x0100});
  payload.put(static_cast<std::uint32_t>(urdf.size() + 1));
  payload.put(bytes_of(urdf));
  payload.put(std::uint8_t{0});
  return file_->write(channel, 0, time_ns, payload.bytes());
}

bool Recorder::describe_parts(const std::string& description, std::int64_t time_ns) {
  const std::uint16_t schema = file_->add_schema("kadans.Description", "jsonschema", description_schema);
  return file_->write(file_->add_channel("/description", "json", schema), 0, time_ns, bytes_of(description));
}

void Recorder::record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept {
  if (stride_ == 0 || tick % stride_ != 0) return;
  std::array<double, head_size> head{};
  std::memcpy(&head[0], &tick, sizeof tick);
  std::memcpy(&head[1], &time_ns, sizeof time_ns);
  if (row.size() != signal_count_ || !ring_->try_push(head, row)) dropped_.fetch_add(1, std::memory_order_relaxed);
}

bool Recorder::drain() {
  const std::size_t row_size = head_size + signal_count_;
  for (std::size_t waiting = ring_->size() / row_size; waiting > 0; --waiting) {
    std::uint64_t tick = 0;
    std::int64_t time_ns = 0;
    std::memcpy(&tick, &ring_->peek(0), sizeof tick);
    std::memcpy(&time_ns, &ring_->peek(1), sizeof time_ns);
    write_events(time_ns);
    write_row(tick, time_ns);
    ring_->drop(row_size);
  }
  write_events(end_of_time_ns);
  report_drops();
  return error().empty();
}

void Recorder::write_row(std::uint64_t tick, std::int64_t time_ns) {
  bool written = true;
  for (const Topic& topic : topics_) {
    if (tick % topic.every_ticks != 0) continue;
    values_.resize(topic.signals.signals.size());
    std::ranges::transform(topic.signals.signals, values_.begin(),
                           [this](SignalId id) { return ring_->peek(head_size + id); });
    payload_.resize(cdr_bytes(values_.size(), precision_));
    write_cdr(payload_, values_, precision_);
    written = file_->write(topic.channel, static_cast<std::uint32_t>(tick), time_ns, payload_) && written;
  }
  ++rows_;
  if (!written) ++lost_;
  last_time_ns_ = time_ns;
}

void Recorder::write_events(std::int64_t until_ns) {
  while (events_.pop(until_ns, event_)) write_event(event_);
}

void Recorder::write_event(const Event& event) {
  const std::uint16_t channel = event.kind == Event::Kind::transition ? transition_channel_ : log_channel_;
  const std::string json = json_of(event);
  // A file that failed is told by error(); there is nothing else to do about it here.
  (void)file_->write(channel, 0, event.transition.time_ns, bytes_of(json));
}

void Recorder::report_drops() {
  const std::uint32_t drops = dropped() + dropped_events();
  if (drops == reported_drops_) return;
  Event event;
  event.severity = BehaviorLog::Severity::warning;
  event.transition.time_ns = last_time_ns_;
  event.transition.behavior = "recorder";
  event.text = std::to_string(dropped()) + " rows and " + std::to_string(dropped_events()) +
               " events so far are not in this record: its writer was too slow";
  write_event(event);
  reported_drops_ = drops;
}

bool Recorder::close() {
  (void)drain();
  if (file_->is_open() && error().empty()) {
    (void)file_->add_metadata("recorder", {{"rows", std::to_string(rows_)},
                                           {"dropped_rows", std::to_string(dropped())},
                                           {"dropped_events", std::to_string(dropped_events())}});
  }
  return file_->close();
}

}  // namespace kadans
