// The signal table as the tools of ROS 2 see it: one topic for the first part of the names, one message field a signal.
//
//   joint.l_knee.effort_Nm  ->  topic /joint, type kadans_msgs/msg/Joint, field l_knee.effort_nm
//
// Each middle part is a nested message type. All fields are of one number type, so a message is the CDR header and the
// numbers side by side, in the order of the schema: `signals` says which signal stands where. ROS 2 allows only small
// letters, digits and single '_' in a field's name: others change, and names that collide so get a number; the
// description keeps them as they were. A name of one part is the field `value` of its own topic.
//
// Where signals of one topic are recorded at different rates, those of the fastest stand there, the others each in a
// topic of their rate: /joint, /joint/every_10.
#pragma once

#include <cstddef>
#include <cstdint>
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
  std::string description;        // the same order, a line each: name, unit and sentence, separated by tabs
  std::uint32_t every_ticks = 1;
};

// Before the loop. The fastest first, then in the order in which the table first names each topic. `every_ticks`: by
// signal, 0 leaves it out; none given: all in each tick.
std::vector<SignalTopic> signal_topics(const SignalTable& table, Precision precision,
                                       std::span<const std::uint32_t> every_ticks = {});

inline constexpr std::size_t cdr_head_bytes = 4;

inline std::size_t cdr_bytes(std::size_t values, Precision precision) noexcept {
  return cdr_head_bytes + values * (precision == Precision::full ? sizeof(double) : sizeof(float));
}

// payload.size() == cdr_bytes(values.size(), precision)
void write_cdr(std::span<std::byte> payload, std::span<const double> values, Precision precision) noexcept;
// False, and nothing is read, when the payload is not what write_cdr makes of so many values.
[[nodiscard]] bool read_cdr(std::span<const std::byte> payload, std::span<double> values, Precision precision) noexcept;

}  // namespace kadans
