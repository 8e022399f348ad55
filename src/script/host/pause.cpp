#include "pause.h"

#include "signal/byte_order.h"

namespace kadans {
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
