// Makes messages that general viewers understand without configuration from a row of signals: joint states, the
// transform of the base (viewers compute the links from the URDF and the joints), and the wrench on each sole. A record
// holds the same messages that the live server sends. Topics and frames of a further robot of the world begin with its
// name: /left/joint_states, left/torso. The transforms of all robots' bases are one message.
//
// Call all but write() before the loop; write() is called by one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/tick/tick_statistics.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/signal.h"
#include "signal/byte_order.h"

namespace kadans {

// Names as in the model and in the signal table.
struct ViewerSubjects {
  std::vector<std::string> joints;
  std::string base;                         // link
  std::vector<std::string> feet;            // links
  std::string robot = {};                   // name of a further robot, with which its signals begin
  std::vector<ViewerSubjects> others = {};  // the further robots

  bool empty() const noexcept { return joints.empty() && base.empty() && feet.empty(); }
};
// A fault of the first robot or, where Fault::robot says so, of a further one.
ToldFault told(const Fault& fault, const ViewerSubjects& subjects, std::int64_t time_ns);

struct ViewerChannel {
  std::string topic, encoding, schema_name, schema_encoding, schema;
};
ViewerChannel json_channel(const std::string& topic, const std::string& schema_name, const std::string& schema);
// Of what is told in JSON, on the topic of this name.
extern const ViewerChannel log_channel, transitions_channel, active_channel, events_channel, faults_channel,
    parameters_channel, timing_channel, description_channel;

class ViewerMessages {
 public:
  ViewerMessages(const SignalTable& signals, const ViewerSubjects& subjects);

  // Empty when there are no subjects.
  const std::vector<ViewerChannel>& channels() const noexcept { return channels_; }
  // Replaces the contents of `to` by the message of a channel. `row` holds all signals.
  void write(std::size_t channel, std::int64_t time_ns, std::span<const double> row, ByteWriter& to);

 private:
  struct Joint {
    std::optional<SignalId> position, velocity, effort;
  };
  struct Foot {
    std::optional<SignalId> force, cop_x, cop_y;
  };
  struct Base {
    std::optional<SignalId> roll, pitch, yaw, x, y, z;
  };

  struct Robot {
    ViewerSubjects subjects;
    std::string frames;  // what its frames begin with
    std::string named;   // its frames in the message of its base
    std::vector<Joint> joints;
    std::vector<Foot> feet;
    Base base;
  };
  struct Content {
    enum class Kind : std::uint8_t { joint_states, bases, wrench };
    Kind kind;
    std::size_t robot = 0, foot = 0;
  };

  void add(const SignalTable& signals, const ViewerSubjects& subjects);
  void write_joint_states(const Robot& robot, std::int64_t time_ns, std::span<const double> row, ByteWriter& to);
  void write_bases(std::int64_t time_ns, std::span<const double> row, ByteWriter& to);

  std::vector<Robot> robots_;
  std::vector<ViewerChannel> channels_;
  std::vector<Content> contents_;  // of the channels
  std::vector<double> values_;
  std::string text_;
};

// The URDF for viewers, which is one message at the start. `robot`: as in ViewerSubjects.
ViewerChannel robot_description_channel(const std::string& robot);
void write_robot_description(const std::string& urdf, ByteWriter& to);

// Histograms of the durations of ticks and tasks, which viewers read on /timing.
struct TimingSource {
  std::string name;
  const TickStatistics* statistics;
};

// {"control tick": {"unit", "low", "high", "counts", "median", "p99", "max", "count", "limits", "within"}}, in
// microseconds. `within` counts the durations up to each of `limits`, which never change. So the difference between two
// messages is the histogram of the time between them. Any thread.
std::string timing_json(const std::vector<TimingSource>& sources);

}  // namespace kadans
