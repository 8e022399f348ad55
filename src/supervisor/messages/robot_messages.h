// Messages between robots: events of a k.decisions that go out by m:send, and come in as events of another robot's.
//
//   {"kadans":1,"from":"red_2","boot":8123,"number":17,"sent_ms":123456,"event":"robot.pass","data":{"x_m":1.5}}
//
// A message is trusted for nothing. It is at most message_bytes_max long; its keys are these alone; its sender is one
// of the peers that the configuration names, which keeps out mistakes, not enemies; its event is one whose name begins
// with "robot."; its data must fit the receiver's own declaration of the event, in the receiver's own file.
//
// Old and doubled ones do not count: within one start of its sender (`boot`) each has a higher number than the ones
// before. The clocks of two robots are not the same. So the age of a message is what it took longer than the fastest
// one of its sender did, and one that took too long is refused.
//
// What goes out keeps to a budget, of messages and of bytes, in each minute. What does not fit is refused, never
// delayed: the decisions hear it at once (nil, "queue_full"), or with their next tick as a warning.
//
// Supervisor thread. No robot, no socket: bytes in, bytes out.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/robot/supervisor_config.h"
#include "config/scenario/play_item.h"

namespace kadans {

inline constexpr std::size_t message_bytes_max = 512;

class RobotMessages {
 public:
  enum class Answer : std::uint8_t { taken, own, wrong, stranger, repeated, too_old };

  // `boot`: another number for each start.
  RobotMessages(const MessagesConfig& config, std::uint32_t boot) : config_(config), boot_(boot) {}

  // The bytes of a message; "": refused, and `why` says so.
  std::string encode(const PlayedEvent& event, std::int64_t now_ns, std::string& why);
  // What a datagram says. Unless it is taken, `why` says what is wrong.
  Answer decode(std::string_view datagram, std::int64_t now_ns, PlayedEvent& event, std::string& why);

 private:
  struct Peer {
    std::uint32_t boot = 0, number = 0;
    double fastest_ms = 0;  // the least that its clock was behind this one's when a message came
  };

  Answer read(std::string_view datagram, std::int64_t now_ns, PlayedEvent& event);
  bool within_budget(std::size_t bytes, std::int64_t now_ns);

  MessagesConfig config_;
  std::uint32_t boot_, number_ = 0;
  std::deque<std::pair<std::int64_t, std::size_t>> sent_;  // in the last minute: time, bytes
  std::size_t sent_bytes_ = 0;
  std::map<std::string, Peer> peers_;
};

}  // namespace kadans
