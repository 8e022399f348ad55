#include "pause.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "signal/byte_order.h"

namespace kadans {
namespace {

constexpr std::int64_t forever_ns = std::numeric_limits<std::int64_t>::max();
constexpr double going_on_min_s = 0.1;  // from rest, so that a motion almost there makes no step

}  // namespace

MotionsUnderWay::MotionsUnderWay(const Catalog& catalog)
    : catalog_(catalog),
      partition_(catalog),
      active_(catalog.initial_sets),
      motions_(catalog.setpoints.size()),
      velocity_(catalog.setpoints.size()) {
  for (SetpointId id = 0; id < motions_.size(); ++id) velocity_[id] = catalog.setpoints[id].unit.ends_with("/s");
}

void MotionsUnderWay::note(std::span<const Command> transaction, std::int64_t now_ns) {
  for (const Command& command : transaction) {
    switch (command.kind) {
      case CommandKind::set_point:
      case CommandKind::trapezoid:
      case CommandKind::via_point:
        begin(command, now_ns);
        break;
      case CommandKind::cancel_motion:
        motions_[command.index].clear();
        break;
      case CommandKind::switch_set:
        switch_to(command.index);
        break;
      default:
        break;
    }
  }
}

void MotionsUnderWay::begin(const Command& command, std::int64_t now_ns) {
  Motion& motion = motions_[command.index];
  const bool follows = command.kind == CommandKind::via_point && command.count > 0 && !motion.empty();
  const bool lasts =
      command.kind == CommandKind::trapezoid ? command.duration_s <= 0 : velocity_[command.index] && command.value != 0;
  const std::int64_t from_ns = follows ? motion.back().end_ns : now_ns;
  if (!follows) motion.clear();
  motion.push_back({command, lasts ? forever_ns : from_ns + std::llround(command.duration_s * 1e9)});
}

// What leaves with its set stands still.
void MotionsUnderWay::switch_to(std::uint32_t set) noexcept {
  active_ = partition_.after(active_, set);
  const ObjectMask running = partition_.objects(active_);
  for (SetpointId id = 0; id < motions_.size(); ++id) {
    if ((running >> catalog_.setpoints[id].owner & 1U) == 0) motions_[id].clear();
  }
}

void MotionsUnderWay::forget() noexcept {
  for (Motion& motion : motions_) motion.clear();
}

void MotionsUnderWay::keep(ByteWriter& bytes, std::int64_t now_ns) const {
  bytes.put(active_);
  for (SetpointId id = 0; id < motions_.size(); ++id) {
    if (!under_way(motions_[id], now_ns)) continue;
    for (const Leg& leg : motions_[id]) {
      bytes.put<std::uint8_t>(1);
      bytes.put(id);
      bytes.put(std::as_bytes(std::span(&leg.command, 1)));
      bytes.put(leg.end_ns);
    }
  }
  bytes.put<std::uint8_t>(0);
}

void MotionsUnderWay::restore(ByteReader& bytes) {
  active_ = bytes.take<SetMask>();
  while (bytes.take<std::uint8_t>() != 0) {
    const auto id = bytes.take<SetpointId>();
    Leg leg;
    const auto command = bytes.take_bytes(sizeof leg.command);
    if (!command.empty()) std::memcpy(static_cast<void*>(&leg.command), command.data(), sizeof leg.command);
    leg.end_ns = bytes.take<std::int64_t>();
    if (bytes.ok() && id < motions_.size()) motions_[id].push_back(leg);
  }
}

bool MotionsUnderWay::any(std::int64_t now_ns) const noexcept {
  return std::ranges::any_of(motions_, [&](const Motion& motion) { return under_way(motion, now_ns); });
}

bool MotionsUnderWay::rest(std::int64_t now_ns, CommandSender& commands) const noexcept {
  for (SetpointId id = 0; id < motions_.size(); ++id) {
    if (!under_way(motions_[id], now_ns)) continue;
    if (!commands.add({.kind = CommandKind::cancel_motion, .index = id})) return false;
  }
  return true;
}

bool MotionsUnderWay::go_on(std::int64_t now_ns, CommandSender& commands) const noexcept {
  return std::ranges::all_of(motions_, [&](const Motion& motion) { return go_on(motion, now_ns, commands); });
}

// What is left of it, beginning at rest.
bool MotionsUnderWay::go_on(const Motion& motion, std::int64_t now_ns, CommandSender& commands) noexcept {
  std::int64_t from_ns = now_ns;
  std::uint32_t number = 0;
  for (const Leg& leg : motion) {
    if (leg.end_ns <= now_ns) continue;
    Command command = leg.command;
    if (command.kind == CommandKind::via_point) command.count = number++;
    const double left_s = 1e-9 * static_cast<double>(leg.end_ns - from_ns);
    if (leg.end_ns != forever_ns) command.duration_s = number > 1 ? left_s : std::max(left_s, going_on_min_s);
    if (leg.end_ns == forever_ns && command.kind == CommandKind::set_point) command.duration_s = going_on_min_s;
    if (!commands.add(command)) return false;
    from_ns = leg.end_ns;
  }
  return true;
}

namespace {

constexpr std::int64_t wait_for_engine_ns = 1'000'000'000;  // for a transaction that the control engine never takes

}  // namespace

void Pause::begin() noexcept {
  if (phase_ == Phase::going) phase_ = Phase::resting;
  if (phase_ == Phase::none || phase_ == Phase::sent) phase_ = Phase::coming;
}

void Pause::end() noexcept {
  if (phase_ == Phase::coming) return run_on();
  if (phase_ == Phase::resting) phase_ = Phase::going;
}

void Pause::keep(ByteWriter& bytes, std::int64_t time_ns) const {
  bytes.put(static_cast<std::uint8_t>(phase_));
  if (phase_ != Phase::none) {  // in between these change with every tick
    bytes.put(stands_ns_);
    bytes.put(sent_ns_);
    bytes.put(sequence_);
    bytes.put<std::uint8_t>(standing_);
  } else {
    bytes.put(held_ns_);
  }
  motions_.keep(bytes, time_ns - held_ns_);
}

void Pause::restore(ByteReader& bytes) {
  const auto phase = bytes.take<std::uint8_t>();
  phase_ = phase <= static_cast<std::uint8_t>(Phase::sent) ? static_cast<Phase>(phase) : Phase::none;
  if (phase_ != Phase::none) {
    stands_ns_ = bytes.take<std::int64_t>();
    sent_ns_ = bytes.take<std::int64_t>();
    sequence_ = bytes.take<std::uint32_t>();
    standing_ = bytes.take<std::uint8_t>() != 0;
  } else {
    held_ns_ = bytes.take<std::int64_t>();
  }
  motions_.restore(bytes);
}

void Pause::run_on() noexcept {
  phase_ = Phase::none;
  standing_ = false;
}

bool Pause::holds(const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (phase_ == Phase::none) return false;
  if (!standing_) stands_ns_ = now_ns(snapshot);
  standing_ = true;
  held_ns_ = snapshot.time_ns - stands_ns_;
  if (phase_ == Phase::coming && send_rest(snapshot, commands)) {
    phase_ = Phase::resting;
  } else if (phase_ == Phase::going && !motions_.any(stands_ns_)) {
    run_on();
  } else if (phase_ == Phase::going && send_on(snapshot, commands)) {
    phase_ = Phase::sent;
  } else if (phase_ == Phase::sent) {
    const bool taken = snapshot.transactions_applied >= sequence_;
    if (taken || snapshot.time_ns - sent_ns_ > wait_for_engine_ns) run_on();
  }
  return phase_ != Phase::none;
}

bool Pause::send_rest(const Snapshot& snapshot, CommandSender& commands) noexcept {
  commands.begin(snapshot.time_ns);
  const bool fits = motions_.rest(now_ns(snapshot), commands);
  return commands.commit() != 0 || (fits && !motions_.any(now_ns(snapshot)));
}

bool Pause::send_on(const Snapshot& snapshot, CommandSender& commands) noexcept {
  commands.begin(snapshot.time_ns);
  const bool fits = motions_.go_on(stands_ns_, commands);
  sequence_ = commands.commit();
  sent_ns_ = snapshot.time_ns;
  return fits && sequence_ != 0;
}

void Pause::note(const Snapshot& snapshot, const CommandSender& commands) noexcept {
  motions_.note(commands.committed(), now_ns(snapshot));
}

void Pause::finish(const Snapshot& snapshot, CommandSender& commands) noexcept {
  (void)send_rest(snapshot, commands);
  motions_.forget();
  run_on();
}

}  // namespace kadans
