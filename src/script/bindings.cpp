#include "bindings.h"

#include <algorithm>

#include "tick_code.h"

namespace kadans {

bool Bindings::has_object(std::uint32_t object) const noexcept {
  return set == nullptr || std::find(set->objects.begin(), set->objects.end(), object) != set->objects.end();
}

KADANS_TICK_CODE bool Bindings::send(const Command& command) noexcept {
  if (sender->add(command)) return true;
  refused = true;
  return false;
}

KADANS_TICK_CODE void Bindings::begin(CommandSender& to, const Snapshot& seen, std::int64_t time_ns) noexcept {
  sender = &to;
  snapshot = &seen;
  now_ns = time_ns - held_ns;
  refused = false;
  motion_count = 0;
  to.begin(time_ns);
}

KADANS_TICK_CODE bool Bindings::commit() noexcept {
  const std::uint32_t sequence = sender->commit();
  const bool sent = !refused && (sequence != 0 || sender->last_sequence() == 0);
  for (std::uint32_t i = 0; i < motion_count; ++i) {
    Motion& motion = *motions[i];
    motion.sequence = sequence;
    if (motion.state == MotionState::pending) motion.state = sent ? MotionState::sent : MotionState::refused;
  }
  motion_count = 0;
  return sent;
}

}  // namespace kadans
