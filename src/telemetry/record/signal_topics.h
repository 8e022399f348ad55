// Maps the signal table to topics and messages of ROS 2: one topic for each first part of the names, one message field
// for each signal.
//
//   joint.l_knee.effort_Nm  ->  topic /joint, type kadans_msgs/msg/Joint, field l_knee.effort_nm
//   control.walk.phase_rad  ->  topic /control/walk, type kadans_msgs/msg/ControlWalk, one for each control object
//
// Each middle part of a name is a nested message type. All fields have the same number type, so a message is the CDR
// header followed by the numbers in the order of the schema; `signals` says which signal is where. ROS 2 allows only
// lower-case letters, digits and single '_' in the name of a field. Other characters are changed, and names that become
// equal get a number; the description keeps the original names. A signal whose name has one part is the field `value`
// of its own topic.
//
// When signals of one topic are recorded at different rates, the topic holds those of the highest rate. Each other rate
// has a topic of its own: /joint, /joint/every_10.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kadans/signal/signal.h"

namespace kadans {

enum class Precision : std::uint8_t { full, single };  // float64, float32

struct SignalTopic {
  std::string topic;              // "/joint"
  std::string type;               // "kadans_msgs/msg/Joint"
  std::string definition;         // ros2msg text, the units and sentences as comments
  std::vector<SignalId> signals;  // in the order of the message
  std::string description;  // in the same order, one line for each signal: name, unit and sentence, separated by tabs
  std::uint32_t every_ticks = 1;
  // The same signals as runs of neighbours in the table.
  struct Run {
    SignalId first;
    std::uint32_t count;
  };
  std::vector<Run> runs = {};
};

// Call it before the loop. The topics with the highest rate come first, then in the order in which the table first
// names each topic. `every_ticks` is given for each signal, 0 leaves it out; empty: all in each tick.
std::vector<SignalTopic> signal_topics(const SignalTable& table, Precision precision,
                                       std::span<const std::uint32_t> every_ticks = {});

inline constexpr std::size_t cdr_head_bytes = 4;

inline std::size_t cdr_bytes(std::size_t values, Precision precision) noexcept {
  return cdr_head_bytes + values * (precision == Precision::full ? sizeof(double) : sizeof(float));
}

// The message of a topic. `row` holds all signals; payload.size() == cdr_bytes(topic.signals.size(), precision)
void write_cdr(std::span<std::byte> payload, const SignalTopic& topic, std::span<const double> row,
               Precision precision) noexcept;
// Whether that message is `payload`, which the call above has written.
[[nodiscard]] bool is_cdr(std::span<const std::byte> payload, const SignalTopic& topic, std::span<const double> row,
                          Precision precision) noexcept;
// payload.size() == cdr_bytes(values.size(), precision)
void write_cdr(std::span<std::byte> payload, std::span<const double> values, Precision precision) noexcept;
// Returns the precision that it has. nullopt when the payload is not what write_cdr makes of values.size() values; then
// nothing is read.
[[nodiscard]] std::optional<Precision> read_cdr(std::span<const std::byte> payload, std::span<double> values) noexcept;

}  // namespace kadans
