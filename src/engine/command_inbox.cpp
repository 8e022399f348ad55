#include "kadans/engine/command_inbox.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace kadans {

CommandInbox::CommandInbox(CommandQueue& queue, Catalog& catalog, ControlSets& sets,
                           std::uint32_t commands_per_tick_max, std::int64_t age_max_ns)
    : queue_(queue),
      catalog_(catalog),
      sets_(sets),
      commands_per_tick_max_(commands_per_tick_max),
      age_max_ns_(age_max_ns),
      motions_(catalog, sets) {
  if (commands_per_tick_max_ + 1 < max_transaction) {
    throw std::invalid_argument("commands_per_tick_max " + std::to_string(commands_per_tick_max_) +
                                " would never let the largest transaction pass: at least " +
                                std::to_string(max_transaction - 1));
  }
}

bool CommandInbox::acceptable(const Command& command) const noexcept {
  switch (command.kind) {
    case CommandKind::transaction:
      return false;  // a header inside a transaction
    case CommandKind::set_parameter:
      return catalog_.parameters.accepts(command.index, command.value);
    case CommandKind::set_point:
      return catalog_.setpoints.accepts(command.index, command.value) && command.duration_s >= 0 &&
             command.duration_s <= motion_duration_max_s;
    case CommandKind::cancel_motion:
      return command.index < catalog_.setpoints.size();
    case CommandKind::switch_set:
      return command.index < catalog_.sets.size();
    case CommandKind::clear_faults:
      return true;
    case CommandKind::trapezoid:
    case CommandKind::via_point:
      return SetpointMotions::acceptable(command, catalog_.setpoints);
  }
  return false;
}

bool CommandInbox::held(const Command& command, const Catalog& catalog, const Safety& safety) noexcept {
  if (command.kind == CommandKind::clear_faults || command.kind == CommandKind::cancel_motion) return false;
  if (safety.robot_level() >= SafetyLevel::hold) return true;
  const auto joint_held = [&](std::size_t joint) { return safety.joint_level(joint) == SafetyLevel::hold; };
  const auto object_held = [&](std::uint32_t object) {
    return object < catalog.objects.size() && std::ranges::any_of(catalog.objects[object].joints, joint_held);
  };
  switch (command.kind) {
    case CommandKind::set_point:
    case CommandKind::trapezoid:
    case CommandKind::via_point: {
      const Setpoint& setpoint = catalog.setpoints[command.index];
      return setpoint.joint < catalog.model->joints.size() ? joint_held(setpoint.joint) : object_held(setpoint.owner);
    }
    case CommandKind::set_parameter:
      return object_held(catalog.parameters.owner(command.index));
    case CommandKind::switch_set:
      for (std::size_t joint = 0; joint < catalog.model->joints.size(); ++joint) {
        if (joint_held(joint)) return true;
      }
      return false;
    default:
      return false;
  }
}

bool CommandInbox::transaction_acceptable(std::uint32_t count, const Safety& safety) const noexcept {
  bool cleared = false;
  for (std::uint32_t i = 1; i <= count; ++i) {
    const Command& command = queue_.peek(i);
    if (!acceptable(command)) return false;
    cleared = cleared || command.kind == CommandKind::clear_faults;
    if (!cleared && held(command, catalog_, safety)) return false;
  }
  return true;
}

void CommandInbox::execute(const Command& command, const ControlInput& input, Safety& safety) noexcept {
  switch (command.kind) {
    case CommandKind::transaction:
      break;
    case CommandKind::set_parameter:
      if (catalog_.parameters.set(command.index, command.value))
        retuned_[catalog_.parameters.owner(command.index)] = true;
      break;
    case CommandKind::set_point: {
      const Setpoint& setpoint = catalog_.setpoints[command.index];
      motions_.drop(command.index);
      sets_.object(setpoint.owner).set_point(setpoint.channel, command.value, command.duration_s);
      break;
    }
    case CommandKind::cancel_motion: {
      const Setpoint& setpoint = catalog_.setpoints[command.index];
      motions_.drop(command.index);
      sets_.object(setpoint.owner).cancel_motion(setpoint.channel);
      break;
    }
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
  }
}

void CommandInbox::notify_owners() noexcept {
  for (std::uint32_t i = 0; i < sets_.size(); ++i) {
    if (std::exchange(retuned_[i], false)) sets_.object(i).parameters_changed();
  }
}

void CommandInbox::apply(std::uint64_t tick, const ControlInput& input, Safety& safety) noexcept {
  std::uint32_t share = commands_per_tick_max_;
  std::size_t waiting = queue_.size();
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
    if (header.count > share) return;
    const bool fresh = input.time_ns - header.time_ns <= age_max_ns_;
    if (fresh && transaction_acceptable(header.count, safety)) {
      for (std::uint32_t i = 1; i <= header.count; ++i) execute(queue_.peek(i), input, safety);
      notify_owners();
      state_.applied += header.count;
      state_.last_transaction = header.sequence;
    } else {
      state_.refused += header.count;
      const FaultCode code = fresh ? FaultCode::command_refused : FaultCode::command_old;
      safety.raise({.code = code, .tick = tick, .value = static_cast<double>(header.sequence)});
    }
    share -= header.count;
    queue_.drop(header.count + 1);
    waiting -= header.count + 1;
  }
}

}  // namespace kadans
