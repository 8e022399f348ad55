#include "armed_transactions.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kadans {

bool ArmedTransactions::has_room(std::uint32_t others) const noexcept { return waiting() + others < max_armed; }

std::uint32_t ArmedTransactions::waiting() const noexcept {
  return static_cast<std::uint32_t>(std::ranges::count(status_, ArmedState::waits, &ArmedStatus::state));
}

RefusalReason ArmedTransactions::judge(const Command& condition) const noexcept {
  using enum RefusalReason;
  if (condition.kind != CommandKind::condition) return malformed;
  if (condition.count > static_cast<std::uint32_t>(last_condition_kind)) return malformed;
  switch (static_cast<ConditionKind>(condition.count)) {
    case ConditionKind::above:
    case ConditionKind::below:
      if (!catalog_.signals.find_key(condition.time_ns)) return unknown;
      return std::isfinite(condition.value) ? none : out_of_range;
    case ConditionKind::after:
      return condition.value >= 0 && condition.value <= motion_duration_max_s ? none : out_of_range;
    case ConditionKind::arrived:
      return condition.index < catalog_.setpoints.size() ? none : unknown;
  }
  return malformed;
}

bool ArmedTransactions::can_wait(CommandKind kind) noexcept {
  switch (kind) {
    case CommandKind::set_parameter:
    case CommandKind::set_point:
    case CommandKind::cancel_motion:
    case CommandKind::switch_set:
    case CommandKind::trapezoid:
    case CommandKind::via_point:
      return true;
    case CommandKind::transaction:
    case CommandKind::clear_faults:  // what ends a hold must be a decision of now
    case CommandKind::order_drive:
    case CommandKind::reset_odometry:
    case CommandKind::arm:
    case CommandKind::condition:
    case CommandKind::disarm:
      return false;
  }
  return false;
}

// The free place that ended first.
ArmedTransactions::Slot& ArmedTransactions::begin(const Command& arm, std::uint32_t sequence, std::uint16_t which,
                                                  std::int64_t time_ns) noexcept {
  std::size_t place = 0;
  const auto taken = [&](std::size_t i) { return status_[i].state == ArmedState::waits; };
  for (std::size_t i = 1; i < slots_.size(); ++i) {
    if (!taken(i) && (taken(place) || slots_[i].ended < slots_[place].ended)) place = i;
  }
  Slot& slot = slots_[place];
  slot.condition_count = slot.command_count = 0;
  slot.expected_conditions = arm.index;
  slot.options = arm.sequence;
  slot.armed_ns = time_ns;
  slot.expires_ns = time_ns + std::llround(1e9 * arm.duration_s);
  slot.was_true = false;
  status_[place] = {.sequence = sequence, .which = which, .state = ArmedState::waits};
  return slot;
}

void ArmedTransactions::add(Slot& slot, const Command& command) const noexcept {
  if (slot.condition_count < slot.expected_conditions) {
    Command& condition = slot.conditions[slot.condition_count++] = command;
    const auto kind = static_cast<ConditionKind>(command.count);
    if (kind == ConditionKind::above || kind == ConditionKind::below)
      condition.index = catalog_.signals.find_key(command.time_ns).value_or(0);  // judge() knew it
  } else {
    slot.commands[slot.command_count++] = command;
  }
}

void ArmedTransactions::end(std::size_t index, ArmedState how) noexcept {
  status_[index].state = how;
  slots_[index].ended = ++ended_;
}

void ArmedTransactions::disarm(std::uint32_t sequence, std::uint32_t which) noexcept {
  for (std::size_t i = 0; i < status_.size(); ++i) {
    const ArmedStatus& status = status_[i];
    if (status.state == ArmedState::waits && status.sequence == sequence && status.which == which)
      end(i, ArmedState::taken_back);
  }
}

void ArmedTransactions::disarm_all() noexcept {
  for (std::size_t i = 0; i < status_.size(); ++i) {
    if (status_[i].state == ArmedState::waits) end(i, ArmedState::taken_back);
  }
}

bool ArmedTransactions::holds(const Command& condition, double waited_s) const noexcept {
  switch (static_cast<ConditionKind>(condition.count)) {
    case ConditionKind::above:
      return catalog_.signals.read(condition.index) > condition.value;
    case ConditionKind::below:
      return catalog_.signals.read(condition.index) < condition.value;
    case ConditionKind::after:
      return waited_s >= condition.value;
    case ConditionKind::arrived:
      return !(motions_.remaining_s(catalog_.setpoints[condition.index].owner) > 0);
  }
  return false;
}

bool ArmedTransactions::due(std::size_t index, std::int64_t time_ns) noexcept {
  Slot& slot = slots_[index];
  if (time_ns > slot.expires_ns) {
    end(index, status_[index].fired > 0 ? ArmedState::done : ArmedState::expired);
    return false;
  }
  const double waited_s = 1e-9 * static_cast<double>(time_ns - slot.armed_ns);
  const auto first = slot.conditions.begin(), last = first + slot.condition_count;
  const auto true_now = [&](const Command& condition) { return holds(condition, waited_s); };
  const bool now =
      (slot.options & arm_any) != 0 ? std::any_of(first, last, true_now) : std::all_of(first, last, true_now);
  return !std::exchange(slot.was_true, now) && now;
}

void ArmedTransactions::pass_state(StateBytes& bytes) noexcept {
  bytes(ended_, status_);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    bytes(slot.ended);
    bytes.must(status_[i].state <= ArmedState::taken_back);
    if (status_[i].state != ArmedState::waits && !bytes.measures()) continue;
    bytes(slot.condition_count, slot.command_count, slot.expected_conditions, slot.options, slot.armed_ns,
          slot.expires_ns, slot.was_true);
    bytes.must(slot.condition_count <= max_armed_conditions && slot.command_count <= max_armed_commands);
    if (!bytes.ok()) return;
    for (std::size_t k = 0; k < (bytes.measures() ? max_armed_conditions : slot.condition_count); ++k) {
      Command& condition = slot.conditions[k];
      bytes(condition);
      bytes.must(judge(condition) == RefusalReason::none);
      const auto kind = static_cast<ConditionKind>(condition.count);
      if (bytes.restores() && (kind == ConditionKind::above || kind == ConditionKind::below))
        condition.index = catalog_.signals.find_key(condition.time_ns).value_or(0);
    }
    for (std::size_t k = 0; k < (bytes.measures() ? max_armed_commands : slot.command_count); ++k)
      bytes(slot.commands[k]);  // judged when they are carried out
  }
}

void ArmedTransactions::note(std::size_t index, std::uint64_t tick, RefusalReason refused) noexcept {
  ArmedStatus& status = status_[index];
  if (refused != RefusalReason::none) {
    status.reason = refused;
    return end(index, ArmedState::refused);
  }
  ++status.fired;
  status.fired_tick = tick;
  if ((slots_[index].options & arm_every_time) == 0) end(index, ArmedState::done);
}

}  // namespace kadans
