// All that a record tells of itself, from one pass over it: topics with their rates and sizes, facts of the run,
// states, faults, log, and whether it is whole. Of its rows nothing is kept.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "kadans/telemetry/record_rows.h"
#include "kadans/telemetry/run_inputs.h"

namespace kadans {

struct TopicOutline {
  RecordTopic topic;
  std::uint16_t channel = 0;
  std::uint64_t messages = 0, bytes = 0;  // bytes: of the messages, before compression
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t hash = 0;  // over what all messages say, of a topic that holds neither rows nor events

  double rate_hz() const noexcept;  // 0: fewer than two messages, or all at one time
};

struct RecordOutline {
  std::string file;
  bool complete = false;
  std::string problem;  // of one that is not
  std::uint64_t file_bytes = 0;
  McapReader::Packing packing;
  std::int64_t first_ns = 0, last_ns = 0;  // of its messages
  std::uint64_t rows = 0;                  // of the topic that has most
  std::vector<TopicOutline> topics;        // by channel
  std::vector<Transition> transitions;
  std::vector<Event> log;
  std::vector<ToldFault> faults;
  std::map<std::string, TextMap> metadata;
  std::vector<McapAttachment> attachments;

  std::string fact(const std::string& metadata_name, const std::string& key) const;  // "" when it is not there
  std::string robot() const;  // by the name of its URDF; "" when it has none
  std::vector<std::string> signal_names() const;
};

// Throws InputError when the file cannot be read, is no MCAP file, or holds no message.
RecordOutline outline_of(const std::string& path);

// A stretch of a record's own time.
struct TimeSpan {
  std::int64_t from_ns = std::numeric_limits<std::int64_t>::min(), to_ns = std::numeric_limits<std::int64_t>::max();

  bool holds(std::int64_t time_ns) const noexcept { return time_ns >= from_ns && time_ns <= to_ns; }
};

struct ChosenSignal {
  std::uint16_t channel = 0;
  std::size_t place = 0;  // in the rows of the channel
  Signal info;
};
// By name, by pattern ('*'), or by the front part of names ("joint.l_knee"); in the order asked, each once; all when
// nothing is asked. Throws InputError that names the nearest.
std::vector<ChosenSignal> choose_signals(const RecordOutline& record, const std::vector<std::string>& patterns);
// The channels of topics, the leading '/' may be left out. Throws InputError alike.
std::vector<std::uint16_t> choose_topics(const RecordOutline& record, const std::vector<std::string>& patterns);

}  // namespace kadans
