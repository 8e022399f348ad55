// Reads the messages of a record one after the other and decodes them: rows of named signals, events, JSON, and other
// payloads. The metadata of its channel says what a topic holds, so topics of any name, rate or number of signals can
// be read. The record may have any length. One thread. An outline tells what a whole record holds.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/signal.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/event_log.h"
#include "telemetry/record/run_inputs.h"
#include "telemetry/record/signal_topics.h"

namespace kadans {

struct RecordTopic {
  std::string name;  // "/joint"
  std::string schema, encoding;
  std::vector<Signal> signals;  // in the order of the row's values; empty: the topic holds no rows

  bool is_json() const noexcept { return encoding == "json"; }
};
RecordTopic topic_of(const McapReader& reader, std::uint16_t channel);

class RecordRows {
 public:
  // Throws InputError when the file cannot be read or is no MCAP file.
  explicit RecordRows(const std::string& path) : reader_(path) {}

  // The next message in the order of the file. False at the end, or at the first problem: reader().problem().
  [[nodiscard]] bool next();

  std::uint16_t channel() const noexcept { return message_.channel; }
  const RecordTopic& topic() const noexcept { return *topic_; }
  std::int64_t time_ns() const noexcept { return message_.time_ns; }
  std::uint32_t tick() const noexcept { return message_.sequence; }
  // The values of a row; empty for other messages. Valid until next().
  std::span<const double> values() const noexcept { return values_; }
  Precision precision() const noexcept { return precision_; }
  std::span<const std::byte> payload() const noexcept { return message_.payload; }
  std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(message_.payload.data()), message_.payload.size()};
  }
  const McapMessage& message() const noexcept { return message_; }
  const McapReader& reader() const noexcept { return reader_; }

 private:
  McapReader reader_;
  McapMessage message_;
  std::map<std::uint16_t, RecordTopic> topics_;
  const RecordTopic* topic_ = nullptr;
  std::vector<double> values_;
  Precision precision_ = Precision::full;
};

// A transition or a log line; nullopt when the message is neither, or when it is damaged.
std::optional<Event> event_in(const RecordTopic& topic, std::string_view json, std::int64_t time_ns);
// A fault that the safety layer found, as a message on /faults holds it; nullopt when the message is none.
std::optional<ToldFault> fault_in(const RecordTopic& topic, std::string_view json, std::int64_t time_ns);

// "squat: down -> up (arrived)"
std::string transition_text(const Transition& transition);

inline double seconds(std::int64_t time_ns) noexcept { return 1e-9 * static_cast<double>(time_ns); }

// The outline of a record, from one pass over the file: topics with their rates and sizes, facts of the run,
// transitions, faults, log lines, and whether the file is complete. It does not keep the rows.
struct TopicOutline {
  RecordTopic topic;
  std::uint16_t channel = 0;
  std::uint64_t messages = 0, bytes = 0;  // bytes of the messages, before compression
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t hash = 0;  // over all messages of a topic that holds neither rows nor events
  bool exact = false;      // its rows hold each tick with all bits

  double rate_hz() const noexcept;  // 0: fewer than two messages, or all at one time
};

struct RecordOutline {
  std::string file;
  bool complete = false;
  std::string problem;  // "" when complete
  std::uint64_t file_bytes = 0;
  McapReader::Packing packing;
  std::int64_t first_ns = 0, last_ns = 0;  // of its messages
  std::uint64_t rows = 0;                  // of the topic with the most rows
  std::vector<TopicOutline> topics;        // by channel
  std::vector<Transition> transitions;
  std::vector<Event> log;
  std::vector<Event> active;  // the active states, each time that they changed; none in older records
  std::vector<ToldFault> faults;
  std::map<std::string, TextMap> metadata;
  std::vector<McapAttachment> attachments;

  std::string fact(const std::string& metadata_name, const std::string& key) const;  // "" when it is not there
  std::string robot() const;  // the name of the attached URDF; "" when there is none
  std::vector<std::string> signal_names() const;
};

// Throws InputError when the file cannot be read, is no MCAP file, or holds no message.
RecordOutline outline_of(const std::string& path);

// A span of the record's own time, both ends included.
struct TimeSpan {
  std::int64_t from_ns = std::numeric_limits<std::int64_t>::min(), to_ns = std::numeric_limits<std::int64_t>::max();

  bool holds(std::int64_t time_ns) const noexcept { return time_ns >= from_ns && time_ns <= to_ns; }
};

struct ChosenSignal {
  std::uint16_t channel = 0;
  std::size_t place = 0;  // index in the rows of the channel
  Signal info;
};
// Chooses signals by name, by pattern ('*'), or by the first parts of names ("joint.l_knee"). They come in the order of
// `patterns`, each once; without patterns all are chosen. Throws InputError with the nearest name.
std::vector<ChosenSignal> choose_signals(const RecordOutline& record, const std::vector<std::string>& patterns);
// Chooses the channels of topics. The leading '/' may be left out. Throws InputError with the nearest name.
std::vector<std::uint16_t> choose_topics(const RecordOutline& record, const std::vector<std::string>& patterns);

}  // namespace kadans
