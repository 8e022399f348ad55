// What a process that plays behaviors wrote into the shared memory, as the runtime takes it: it may be dying, or
// hostile, and may change anything at any moment. Each number is read once, bounded, and used from the copy; bytes are
// copied out before they are looked at; indices of the storages there only ever point into them (Ring masks them). What
// commands mean is for the control engine to judge, as it does with those of a thread.
//
// Behavior thread. False from any of these: the process does not keep the rules.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "kadans/engine/behavior_host.h"
#include "kadans/script/behavior_status.h"
#include "kadans/script/play_list.h"
#include "kadans/script/process/behavior_link.h"

namespace kadans {

class ChildAnswer {
 public:
  ChildAnswer();

  static bool is_ready(BehaviorLink& link) noexcept;
  static std::uint64_t fingerprint(BehaviorLink& link) noexcept;
  // Nothing when there is a name that is none.
  static std::optional<std::vector<std::string>> names(BehaviorLink& link);
  static bool answers(BehaviorLink& link, std::uint32_t number) noexcept;

  // Takes the transactions of the answer out of the link; send_on() sends them, as made at this time.
  [[nodiscard]] bool take_commands(BehaviorLink& link);
  void send_on(CommandSender& commands, std::int64_t time_ns) const noexcept;
  // Tells the log what was said, as said at this time.
  [[nodiscard]] bool tell_lines(BehaviorLink& link, BehaviorLog& log, std::int64_t time_ns);
  // Replaces `kept` when it changed; nothing in it: it cannot be kept.
  [[nodiscard]] bool take_kept(BehaviorLink& link, std::optional<std::vector<std::byte>>& kept);
  static void take_status(BehaviorLink& link, PlayStatus& play, std::deque<BehaviorStatus>& behaviors) noexcept;

 private:
  bool tell_line(std::span<const std::byte> line, BehaviorLog& log, std::int64_t time_ns);

  std::vector<std::byte> bytes_;
  std::vector<Command> commands_;
};

}  // namespace kadans
