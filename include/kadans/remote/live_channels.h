// What a live server tells, as channels of the Foxglove WebSocket protocol: the topics of a record under the same names
// and in the same encoding (signal_topics.h), what general viewers look for (joint states, transform of the base,
// URDF), and events.
//
// Nothing here is a queue for a client. A channel of values keeps its newest message and counts how many there were; a
// channel of events keeps the newest `events_kept`. Who reads compares counts: the slow skip values and, far behind,
// the oldest events. One thread: the server's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kadans/remote/instance.h"
#include "kadans/remote/robot_texts.h"
#include "kadans/telemetry/signal_topics.h"
#include "kadans/telemetry/timing_json.h"
#include "kadans/telemetry/viewer_messages.h"

namespace kadans {

struct LiveMessage {
  std::uint64_t time_ns = 0;
  std::vector<std::byte> payload;
};

struct LiveChannel {
  static constexpr std::size_t events_kept = 500;

  std::string topic, encoding, schema_name, schema_encoding, schema;
  bool events = false;
  std::uint64_t count = 0;             // of messages so far
  std::deque<LiveMessage> messages{};  // the newest

  // The message after the `seen` first ones, or the oldest that is still there; nullptr: there is none. `seen` counts
  // it and what was skipped.
  const LiveMessage* next(std::uint64_t& seen) const noexcept;
  void put(std::uint64_t time_ns, std::span<const std::byte> payload);
};

class LiveChannels {
 public:
  LiveChannels(const Instance& instance, const RobotTexts& texts);

  const std::vector<LiveChannel>& all() const noexcept { return channels_; }
  // Names, units and sentences of each topic's fields: the server's metadata.
  const std::map<std::string, std::string>& signals() const noexcept { return signals_; }

  void take(const LatestRow::View& row);
  void take(const Event& event);
  void take(const Fault& fault, std::int64_t time_ns);
  void take_behaviors(const std::string& json);  // behaviors_description, in place of those before
  void take_timing(const std::string& json, std::int64_t time_ns);
  void take_drives(const std::string& json, std::int64_t time_ns);  // nothing when it is as before

 private:
  std::size_t add(LiveChannel channel);
  std::size_t add_viewer(const ViewerChannel& channel);
  std::size_t add_json(const std::string& topic, const std::string& schema, const char* text, bool events);
  void put_json(std::size_t channel, std::int64_t time_ns, const std::string& json);

  const Catalog& catalog_;
  std::vector<SignalTopic> topics_;  // the first channels
  std::vector<LiveChannel> channels_;
  std::map<std::string, std::string> signals_;
  ViewerMessages viewers_;
  std::size_t first_viewer_, log_, transitions_, faults_, timing_, drives_, described_;
  std::string description_, drives_told_;
  ByteWriter message_;
  std::vector<std::byte> payload_;
  std::vector<double> values_;
};

}  // namespace kadans
