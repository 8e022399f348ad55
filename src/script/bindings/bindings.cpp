#include "bindings.h"

#include <algorithm>

namespace kadans {

bool Bindings::has_object(std::size_t machine, std::uint32_t object) const noexcept {
  const ControlSetInfo* set = set_of(machine);
  return set == nullptr || std::find(set->objects.begin(), set->objects.end(), object) != set->objects.end();
}

SetMask Bindings::all_sets() const noexcept {
  SetMask all = 0;
  for (const ControlSetInfo* set : sets) {
    if (set != nullptr) all |= set_bit(static_cast<std::uint32_t>(set - catalog->sets.data()));
  }
  return all;
}

// The snapshot tells which sets are active, unless something of this behavior's is still on its way. A switch to a set
// that is active does nothing.
void Bindings::bring_in(std::size_t machine) noexcept {
  const ControlSetInfo* set = set_of(machine);
  if (set == nullptr) return;
  const auto number = static_cast<std::uint32_t>(set - catalog->sets.data());
  const bool told = sent_count == 0 || snapshot->transactions_applied >= sent[(sent_count - 1) % sent.size()];
  if ((told && (snapshot->control_sets & set_bit(number)) != 0) || (wanted & set_bit(number)) != 0) return;
  wanted |= set_bit(number);
  (void)send({.kind = CommandKind::switch_set, .index = number});
}

void Bindings::bring_in_again() noexcept {
  each_bit(wanted, [&](std::uint32_t set) { (void)send({.kind = CommandKind::switch_set, .index = set}); });
}

const Refusal* Bindings::next_refusal() noexcept {
  const std::uint32_t count = snapshot->transactions_refused;
  if (count - refusals_seen > refusals_shown) refusals_seen = count - refusals_shown;
  while (refusals_seen != count) {
    const Refusal& refusal = snapshot->refusals[refusals_seen++ % refusals_shown];
    if (std::find(sent.begin(), sent.end(), refusal.sequence) != sent.end()) return &refusal;
  }
  return nullptr;
}

bool Bindings::send(const Command& command) noexcept {
  if (sender->add(command)) return true;
  refused = true;
  return false;
}

void Bindings::begin(CommandSender& to, const Snapshot& seen, std::int64_t time_ns) noexcept {
  sender = &to;
  snapshot = &seen;
  now_ns = time_ns - held_ns;
  refused = false;
  motion_count = 0;
  to.begin(time_ns);
}

bool Bindings::commit() noexcept {
  const std::uint32_t sequence = sender->commit();
  const bool taken = !refused && (sequence != 0 || sender->last_sequence() == 0);
  if (taken) wanted = 0;
  if (taken && !sender->committed().empty()) sent[sent_count++ % sent.size()] = sequence;
  for (std::uint32_t i = 0; i < motion_count; ++i) {
    Motion& motion = *motions[i];
    motion.sequence = sequence;
    if (motion.state == MotionState::pending) motion.state = taken ? MotionState::sent : MotionState::queue_full;
  }
  motion_count = 0;
  return taken;
}

}  // namespace kadans
