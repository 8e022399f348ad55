// What a live server offers to its clients: channels of live data, and files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "remote/instance/instance.h"
#include "remote/instance/run_description.h"
#include "telemetry/record/signal_topics.h"
#include "telemetry/record/viewer_messages.h"

namespace kadans {

// The channels of a live server in the Foxglove WebSocket protocol: the topics of a record with the same names and the
// same encoding (signal_topics.h), messages for general viewers (joint states, transform of the base, URDF), and
// events.
//
// There is no queue for a client. A channel of values keeps its newest message and counts all messages; a channel of
// events keeps the newest `events_kept`. A client compares counts, so a slow client skips values, and when it is far
// behind also the oldest events. Server's thread only.
struct LiveMessage {
  std::uint64_t time_ns = 0;
  std::vector<std::byte> payload;
};

struct LiveChannel : ViewerChannel {
  static constexpr std::size_t events_kept = 500;

  bool events = false;
  std::uint64_t count = 0;             // number of messages so far
  std::deque<LiveMessage> messages{};  // the newest

  // Returns the message after the first `seen` ones, or the oldest that is still kept; nullptr when there is none.
  // `seen` is advanced past it and past the skipped messages.
  const LiveMessage* next(std::uint64_t& seen) const noexcept;
  void put(std::uint64_t time_ns, std::span<const std::byte> payload);
};

class LiveChannels {
 public:
  LiveChannels(const Instance& instance, const RobotTexts& texts);

  const std::vector<LiveChannel>& all() const noexcept { return channels_; }
  // The names, units and sentences of each topic's fields, for the server's metadata.
  const std::map<std::string, std::string>& signals() const noexcept { return signals_; }

  void take(const LatestRow::View& row);
  void take(const Event& event);
  void take(const Fault& fault, std::int64_t time_ns);
  void take_behaviors(const std::string& json);  // text of behaviors_description; replaces the earlier one
  void take_timing(const std::string& json, std::int64_t time_ns);
  void take_drives(const std::string& json, std::int64_t time_ns);  // nothing when it is as before

 private:
  std::size_t add(ViewerChannel channel, bool events = false);
  void put_json(std::size_t channel, std::int64_t time_ns, const std::string& json);

  std::vector<SignalTopic> topics_;  // the first channels
  std::vector<LiveChannel> channels_;
  std::map<std::string, std::string> signals_;
  ViewerSubjects subjects_;
  ViewerMessages viewers_;
  std::size_t first_viewer_, log_, transitions_, active_, faults_, timing_, drives_, described_;
  std::string description_, drives_told_;
  ByteWriter message_;
  std::vector<std::byte> payload_;
};

// The files that clients may fetch: the first robot's URDF and the meshes that the robots' URDFs name, of at most 16 MB
// each. Where two URDFs name different files alike, the first counts.
class LiveAssets {
 public:
  LiveAssets(const RobotTexts& texts, const std::string& urdf_file);

  using Content = std::shared_ptr<const std::string>;
  // `uri` is "package://tulip/tulip.urdf", "robot.urdf", or a mesh as the URDF names it, also without "package://".
  // Reads the file; holders of the same content share one copy. Returns nullptr when there is no such asset or it
  // cannot be read.
  Content read(std::string_view uri);

 private:
  void add_meshes(const std::string& urdf, const std::string& urdf_file);

  Content urdf_;
  std::string urdf_uri_;
  std::map<std::string, std::string, std::less<>> files_;         // files by their names in the URDF
  std::map<std::string, std::weak_ptr<const std::string>> read_;  // contents in use, by file
};

}  // namespace kadans
