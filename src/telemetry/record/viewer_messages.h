// Makes messages that general viewers understand without configuration from a row of signals: joint states, the
// transform of the base (viewers compute the links from the URDF and the joints), and the wrench on each sole. A record
// holds the same messages that the live server sends.
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
#include "kadans/signal/signal.h"
#include "signal/byte_order.h"

namespace kadans {

// Names as in the model and in the signal table.
struct ViewerSubjects {
  std::vector<std::string> joints;
  std::string base;               // link
  std::vector<std::string> feet;  // links

  bool empty() const noexcept { return joints.empty() && base.empty() && feet.empty(); }
};

struct ViewerChannel {
  std::string topic, encoding, schema_name, schema_encoding, schema;
};

class ViewerMessages {
 public:
  ViewerMessages(const SignalTable& signals, ViewerSubjects subjects);

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

  void find_signals(const SignalTable& signals);
  void write_joint_states(std::int64_t time_ns, std::span<const double> row, ByteWriter& to);
  void write_base(std::int64_t time_ns, std::span<const double> row, ByteWriter& to) const;
  void write_wrench(std::size_t foot, std::int64_t time_ns, std::span<const double> row, ByteWriter& to) const;

  ViewerSubjects subjects_;
  std::vector<ViewerChannel> channels_;
  std::vector<Joint> joints_;
  std::vector<Foot> feet_;
  Base base_;
  std::vector<double> values_;
};

// The URDF for viewers, which is one message at the start.
ViewerChannel robot_description_channel();
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
inline constexpr const char* timing_schema = R"({"title": "kadans.Timing", "type": "object"})";

}  // namespace kadans
