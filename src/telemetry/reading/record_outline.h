// The outline of a record, from one pass over the file: topics with their rates and sizes, facts of the run,
// transitions, faults, log lines, and whether the file is complete. It does not keep the rows.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "record_rows.h"
#include "telemetry/record/run_inputs.h"

namespace kadans {

struct TopicOutline {
  RecordTopic topic;
  std::uint16_t channel = 0;
  std::uint64_t messages = 0, bytes = 0;  // bytes of the messages, before compression
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t hash = 0;  // over all messages of a topic that holds neither rows nor events

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
