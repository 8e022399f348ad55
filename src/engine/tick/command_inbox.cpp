#include "command_inbox.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace kadans {
namespace {

// While the emergency stop holds nothing is cleared.
bool clears(const Command& command, const Safety& safety) noexcept {
  return command.kind == CommandKind::clear_faults && !safety.stopped();
}

// Orders that set no joint in motion by a drive or by its load, but for `disable`, which takes damping away.
bool keeps_still(const Command& command) noexcept {
  const auto order = static_cast<DriveOrder>(command.count);
  return order == DriveOrder::disable || order == DriveOrder::reset || order == DriveOrder::brake;
}

}  // namespace

CommandInbox::CommandInbox(CommandQueue& queue, Catalog& catalog, ControlSets& sets,
                           std::uint32_t commands_per_tick_max, std::int64_t age_max_ns)
    : queue_(queue),
      catalog_(catalog),
      sets_(sets),
      commands_per_tick_max_(commands_per_tick_max),
      age_max_ns_(age_max_ns),
      motions_(catalog, sets),
      armed_(catalog, motions_) {
  if (commands_per_tick_max_ + 1 < max_transaction) {
    throw std::invalid_argument("commands_per_tick_max " + std::to_string(commands_per_tick_max_) +
                                " would never let the largest transaction pass: at least " +
                                std::to_string(max_transaction - 1));
  }
}

RefusalReason CommandInbox::judge(const Command& command) const noexcept {
  using enum RefusalReason;
  const auto known = [&](std::size_t size, bool accepted) {
    return command.index >= size ? unknown : accepted ? none : out_of_range;
  };
  const auto of_setpoint = [&] {
    return known(catalog_.setpoints.size(), catalog_.setpoints.accepts(command.index, command.value));
  };
  switch (command.kind) {
    case CommandKind::transaction:  // a header inside a transaction
    case CommandKind::arm:          // those that stand where they belong are judged by judge_arm
    case CommandKind::condition:
      return malformed;
    case CommandKind::disarm:
      return none;
    case CommandKind::reset_odometry:
      return catalog_.feet.empty() ? unknown : none;
    case CommandKind::set_parameter:
      return known(catalog_.parameters.size(), catalog_.parameters.accepts(command.index, command.value));
    case CommandKind::set_point: {
      const bool timely = command.duration_s >= 0 && command.duration_s <= motion_duration_max_s;
      return of_setpoint() != none ? of_setpoint() : timely ? none : motion;
    }
    case CommandKind::cancel_motion:
      return known(catalog_.setpoints.size(), true);
    case CommandKind::switch_set:
      return known(catalog_.sets.size(), true);
    case CommandKind::clear_faults:
      return none;
    case CommandKind::trapezoid:
    case CommandKind::via_point:
      if (of_setpoint() != none) return of_setpoint();
      return SetpointMotions::acceptable(command, catalog_.setpoints) ? none : motion;
    case CommandKind::order_drive: {
      const bool is_order = command.count >= 1 && command.count <= static_cast<std::uint32_t>(last_drive_order);
      return is_order ? known(catalog_.model->joints.size(), true) : malformed;
    }
  }
  return malformed;
}

RefusalReason CommandInbox::held(const Command& command, const Safety& safety, SetMask active,
                                 std::uint16_t& joint) const noexcept {
  if (clears(command, safety) || command.kind == CommandKind::cancel_motion || command.kind == CommandKind::disarm ||
      command.kind == CommandKind::reset_odometry)
    return RefusalReason::none;
  if (command.kind == CommandKind::order_drive)
    return safety.stopped() && !keeps_still(command) ? RefusalReason::robot_held : RefusalReason::none;
  if (safety.robot_level() >= SafetyLevel::hold) return RefusalReason::robot_held;
  const auto joint_held = [&](std::size_t at) {
    if (safety.joint_level(at) != SafetyLevel::hold) return false;
    joint = static_cast<std::uint16_t>(at);
    return true;
  };
  const auto object_held = [&](std::uint32_t object) {
    return object < catalog_.objects.size() && std::ranges::any_of(catalog_.objects[object].joints, joint_held);
  };
  bool is_held = false;
  switch (command.kind) {
    case CommandKind::set_point:
    case CommandKind::trapezoid:
    case CommandKind::via_point: {
      const Setpoint& setpoint = catalog_.setpoints[command.index];
      is_held =
          setpoint.joint < catalog_.model->joints.size() ? joint_held(setpoint.joint) : object_held(setpoint.owner);
      break;
    }
    case CommandKind::set_parameter:
      is_held = object_held(catalog_.parameters.owner(command.index));
      break;
    case CommandKind::switch_set: {
      const SetMask changed = (active ^ sets_.partition().after(active, command.index)) | set_bit(command.index);
      each_bit(sets_.partition().joints(changed), [&](std::uint32_t at) { is_held = is_held || joint_held(at); });
      break;
    }
    default:
      break;
  }
  return is_held ? RefusalReason::joint_held : RefusalReason::none;
}

template <typename At>
Refusal CommandInbox::judge_arm(std::uint32_t rest, std::uint32_t armed_before, At at) const noexcept {
  const Command& arm = at(0);
  const auto refused = [](const Command& command, RefusalReason reason) {
    return Refusal{.kind = command.kind, .reason = reason, .index = command.index, .value = command.value};
  };
  const bool whole = arm.count <= rest && arm.index >= 1 && arm.index <= max_armed_conditions &&
                     arm.count > arm.index && arm.count - arm.index <= max_armed_commands;
  if (!whole) return refused(arm, RefusalReason::malformed);
  if (!(arm.duration_s >= 0 && arm.duration_s <= motion_duration_max_s)) return refused(arm, RefusalReason::motion);
  if (!armed_.has_room(armed_before)) return refused(arm, RefusalReason::armed_full);
  for (std::uint32_t i = 1; i <= arm.count; ++i) {
    const Command& command = at(i);
    RefusalReason reason = RefusalReason::malformed;
    if (i <= arm.index) {
      reason = armed_.judge(command);
    } else if (ArmedTransactions::can_wait(command.kind)) {
      reason = judge(command);
    }
    if (reason != RefusalReason::none) return refused(command, reason);
  }
  return {};
}

template <typename At>
Refusal CommandInbox::judge_all(std::uint32_t count, std::int64_t time_ns, const Safety& safety, At at) const noexcept {
  bool cleared = false;
  SetMask active = sets_.active();
  std::uint32_t armed = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Command& command = at(i);
    if (command.kind == CommandKind::arm) {  // whether a joint is held is asked when its conditions are true
      const Refusal refusal =
          judge_arm(count - i - 1, armed++, [&](std::uint32_t behind) -> const Command& { return at(i + behind); });
      if (refusal.reason != RefusalReason::none) return refusal;
      i += command.count;
      continue;
    }
    Refusal refusal{.kind = command.kind, .reason = judge(command), .index = command.index, .value = command.value};
    cleared = cleared || clears(command, safety);
    if (refusal.reason == RefusalReason::none && !cleared)
      refusal.reason = held(command, safety, active, refusal.joint);
    if (refusal.reason != RefusalReason::none) return refusal;
    if (command.kind != CommandKind::switch_set) continue;
    if (const SwitchDwell::Dweller dweller = sets_.dwell().against(active, command.index, time_ns);
        dweller.left_s > 0) {
      refusal.reason = RefusalReason::set_dwells;
      refusal.joint = static_cast<std::uint16_t>(dweller.set);
      refusal.value = dweller.left_s;
      return refusal;
    }
    active = sets_.partition().after(active, command.index);
  }
  return {};
}

void CommandInbox::refuse(const Command& header, Refusal refusal, std::uint64_t tick, Safety& safety) noexcept {
  refusal.sequence = header.sequence;
  refusals_[transactions_refused_++ % refusals_shown] = refusal;
  state_.refused += header.count;
  const FaultCode code = refusal.reason == RefusalReason::too_old ? FaultCode::command_old : FaultCode::command_refused;
  safety.raise({.code = code, .tick = tick, .value = static_cast<double>(header.sequence)});
}

void CommandInbox::fill(Snapshot& snapshot) const noexcept {
  armed_.fill(snapshot);
  snapshot.transactions_applied = state_.last_transaction;
  snapshot.commands_refused = state_.refused;
  if (snapshot.transactions_refused == transactions_refused_) return;
  snapshot.transactions_refused = transactions_refused_;
  snapshot.refusals = refusals_;
}

void CommandInbox::execute(const Command& command, const ControlInput& input, Safety& safety) noexcept {
  switch (command.kind) {
    case CommandKind::transaction:
    case CommandKind::arm:  // execute_all
    case CommandKind::condition:
      break;
    case CommandKind::disarm:
      armed_.disarm(command.sequence, command.index);
      break;
    case CommandKind::reset_odometry:
      odometry_resets_ = true;
      break;
    case CommandKind::set_parameter:
      if (catalog_.parameters.set(command.index, command.value))
        retuned_[catalog_.parameters.owner(command.index)] = true;
      break;
    case CommandKind::set_point:
      motions_.move(command.index, command.value, command.duration_s);
      break;
    case CommandKind::cancel_motion:
      motions_.cancel(command.index);
      break;
    case CommandKind::switch_set:
      notify_owners();  // an object starts with the parameters set before it
      sets_.switch_to(command.index);
      sets_.start_newcomers(input);
      break;
    case CommandKind::clear_faults:
      safety.clear();
      if (safety.came_back()) sets_.restart(input);
      break;
    case CommandKind::trapezoid:
    case CommandKind::via_point:
      motions_.begin(command);
      break;
    case CommandKind::order_drive:
      drive_requests_[command.index].order = static_cast<DriveOrder>(command.count);
      ++drive_requests_[command.index].number;
      ordered_ |= joint_bit(command.index);
      break;
  }
}

// A frame holds one order to each drive: a second one waits for the next tick.
bool CommandInbox::orders_again(std::uint32_t count) const noexcept {
  for (std::uint32_t i = 1; i <= count; ++i) {
    const Command& command = queue_.peek(i);
    const bool known = command.index < catalog_.model->joints.size();
    if (command.kind == CommandKind::order_drive && known && (ordered_ & joint_bit(command.index)) != 0) return true;
  }
  return false;
}

void CommandInbox::revoke_orders(const SensorFrame& sensors) noexcept {
  armed_.disarm_all();
  for (std::size_t i = 0; i < sensors.joint_count; ++i) {
    DriveRequest& request = drive_requests_[i];
    const bool enables = request.order == DriveOrder::enable || request.order == DriveOrder::home;
    if (!enables && request.order != DriveOrder::release) continue;
    const bool under_way = enables && sensors.joints[i].drive != DriveState::enabled;
    request.order = under_way ? DriveOrder::disable : DriveOrder::none;
    if (under_way) ++request.number;
  }
}

void CommandInbox::notify_owners() noexcept {
  for (std::uint32_t i = 0; i < sets_.size(); ++i) {
    if (std::exchange(retuned_[i], false)) sets_.object(i).parameters_changed();
  }
}

void CommandInbox::execute_all(const Command& header, const ControlInput& input, Safety& safety) noexcept {
  std::uint16_t which = 0;
  for (std::uint32_t i = 1; i <= header.count; ++i) {
    const Command& command = queue_.peek(i);
    if (command.kind != CommandKind::arm) {
      execute(command, input, safety);
      continue;
    }
    const auto behind = [&](std::uint32_t k) -> const Command& { return queue_.peek(i + 1 + k); };
    armed_.arm(command, header.sequence, which++, input.time_ns, behind);
    i += command.count;
  }
  notify_owners();
}

void CommandInbox::pass_state(StateBytes& bytes) noexcept {
  for (ParameterId id = 0; id < catalog_.parameters.size(); ++id) {
    double value = catalog_.parameters.get(id);
    bytes(value);
    if (bytes.restores() && bytes.ok()) bytes.must(catalog_.parameters.set(id, value));
  }
  for (std::uint32_t i = 0; bytes.restores() && i < sets_.size(); ++i) sets_.object(i).parameters_changed();
  for (std::size_t joint = 0; joint < catalog_.model->joints.size(); ++joint) {
    bytes(drive_requests_[joint]);
    bytes.must(drive_requests_[joint].order <= last_drive_order);
  }
  bytes(odometry_resets_, state_, last_taken_, transactions_refused_, refusals_);
  motions_.pass_state(bytes);
  armed_.pass_state(bytes);
}

void CommandInbox::carry_out_armed(std::uint64_t tick, const ControlInput& input, Safety& safety) noexcept {
  armed_.step(tick, input.time_ns, [&](std::uint32_t sequence, std::span<const Command> commands) {
    const auto count = static_cast<std::uint32_t>(commands.size());
    const Refusal refusal =
        judge_all(count, input.time_ns, safety, [&](std::uint32_t i) -> const Command& { return commands[i]; });
    if (refusal.reason != RefusalReason::none) {
      refuse({.count = count, .sequence = sequence}, refusal, tick, safety);
      return refusal.reason;
    }
    for (const Command& command : commands) execute(command, input, safety);
    notify_owners();
    state_.applied += count;
    return RefusalReason::none;
  });
}

void CommandInbox::apply(std::uint64_t tick, const ControlInput& input, Safety& safety) noexcept {
  const auto arrived = [this](std::uint32_t i) -> const Command& { return queue_.peek(i + 1); };
  std::uint32_t share = commands_per_tick_max_;
  ordered_ = 0;
  std::size_t waiting = queue_.size();
  arrived_ = static_cast<std::uint32_t>(waiting);
  while (waiting > 0) {
    const Command header = queue_.peek();
    const bool whole =
        header.kind == CommandKind::transaction && header.count < waiting && header.count < max_transaction;
    if (!whole) {  // not ours: a producer that does not keep the rules; nothing behind it can be trusted
      state_.refused += static_cast<std::uint32_t>(waiting);
      queue_.drop(waiting);
      safety.raise({.code = FaultCode::command_refused, .tick = tick, .value = static_cast<double>(waiting)});
      return;
    }
    if (header.count > share || orders_again(header.count)) return;
    const bool fresh = input.time_ns - header.time_ns <= age_max_ns_;
    const Refusal refusal =
        fresh ? judge_all(header.count, input.time_ns, safety, arrived) : Refusal{.reason = RefusalReason::too_old};
    if (refusal.reason == RefusalReason::none) {
      execute_all(header, input, safety);
      state_.applied += header.count;
      state_.last_transaction = header.sequence;
    } else {
      refuse(header, refusal, tick, safety);
    }
    share -= header.count;
    last_taken_ = header.sequence;
    queue_.drop(header.count + 1);
    waiting -= header.count + 1;
  }
}

}  // namespace kadans
