// Reads what the behaviors' process wrote into the shared memory. The process may be dying or hostile, and may change
// anything at any moment. So each number is read once, bounded, and used from the copy. Bytes are copied before they
// are read. Indices of rings can only point into the rings (Ring masks them). The control engine checks the commands,
// as it does with those of a thread.
//
// Behavior thread. A function that returns false means: the process breaks the rules.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "behavior_link.h"
#include "engine/behavior_log.h"
#include "script/behavior/behavior_status.h"
#include "script/host/play_list.h"

namespace kadans {

class ChildAnswer {
 public:
  ChildAnswer();

  static bool is_ready(BehaviorLink& link) noexcept;
  static std::uint64_t fingerprint(BehaviorLink& link) noexcept;
  // nullopt when one of the names is invalid.
  static std::optional<std::vector<std::string>> names(BehaviorLink& link);
  static bool answers(BehaviorLink& link, std::uint32_t number) noexcept;

  // Takes the answer's transactions out of the link. send_on() sends them with `time_ns` as their time.
  [[nodiscard]] bool take_commands(BehaviorLink& link);
  void send_on(CommandSender& commands, std::int64_t time_ns) const noexcept;
  // Passes the lines to the log with `time_ns` as their time.
  [[nodiscard]] bool tell_lines(BehaviorLink& link, BehaviorLog& log, std::int64_t time_ns);
  // Replaces `kept` when it changed; nullopt: the state cannot be kept.
  [[nodiscard]] bool take_kept(BehaviorLink& link, std::optional<std::vector<std::byte>>& kept);
  static void take_status(BehaviorLink& link, PlayStatus& play, std::deque<BehaviorStatus>& behaviors) noexcept;

 private:
  bool tell_line(std::span<const std::byte> line, BehaviorLog& log, std::int64_t time_ns);

  std::vector<std::byte> bytes_;
  std::vector<Command> commands_;
};

}  // namespace kadans
