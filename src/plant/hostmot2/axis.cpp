#include "axis.h"

#include <cmath>

namespace kadans::hostmot2 {
namespace {

constexpr std::uint32_t strange_max = 5;  // readings in a row

}  // namespace

std::string_view drive_code_words(std::uint32_t code) noexcept {
  if ((code & code_forgot) != 0) return "its board lost its settings";
  if ((code & code_watchdog) != 0) return "its board's watchdog let go";
  if ((code & code_silent) != 0) return "its board does not answer";
  if ((code & code_amplifier) != 0) return "its amplifier reports a fault";
  if ((code & code_strange) != 0) return "its encoder jumps";
  if ((code & code_no_zero) != 0) return "its zero was not found";
  return "";
}

Axis::Axis(const DriveWiring& wiring, Board& board, std::size_t joint) noexcept
    : wiring_(wiring),
      board_(board),
      joint_(joint),
      encoder_(board.stamps_per_s()),
      amplifier_(wiring.amplifier),
      sign_(wiring.reversed ? -1 : 1) {
  sample_.drive = DriveState::ready;
  sample_.homed = wiring.home == Home::power_on;
}

// A count that was bent on its way, or an encoder that lost its light: it is not taken.
bool Axis::plausible() noexcept {
  if (!placed_) return placed_ = true;
  const double passed_s = seconds_between(last_ns_, board_.time_ns());
  const double way = static_cast<double>(encoder_.count() - last_count_) / wiring_.counts_per_rad;
  // A few counts beyond, which tremble; a clock that stood still says nothing.
  return std::abs(way) <= wiring_.velocity_max_rad_s * std::max(passed_s, 1e-4) + 3 / wiring_.counts_per_rad;
}

void Axis::take(bool fresh, std::uint32_t silent_ticks_max) noexcept {
  if (board_.missed() >= silent_ticks_max) code_ |= code_silent;
  if (!fresh) return;
  if (board_.bitten()) code_ |= code_watchdog;
  if (board_.forgot()) code_ |= code_forgot;
  if (board_.forgot()) return;  // its count began anew, wherever the joint was
  encoder_.take(board_.encoder(wiring_.encoder), board_.stamp_clock(), seconds_between(last_ns_, board_.time_ns()));
  const bool good = plausible();
  last_count_ = encoder_.count();
  last_ns_ = board_.time_ns();
  if (wiring_.fault && board_.active(*wiring_.fault)) code_ |= code_amplifier;
  if (good) {
    strange_ = 0;
    velocity_rad_s_ = sign_ * encoder_.counts_per_s() / wiring_.counts_per_rad;
    sample_.position_rad = sample_.motor_position_rad = position_of(encoder_.count());
    if (wiring_.spring_Nm_per_rad > 0)
      sample_.motor_position_rad += sample_.motor_effort_Nm / wiring_.spring_Nm_per_rad;
    sample_.time_ns = last_ns_;
    ++sample_.sequence;
  } else {
    ++strange_readings_;
    if (++strange_ >= strange_max) code_ |= code_strange;
  }
}

bool Axis::carry_out(DriveOrder order) noexcept {
  switch (order) {
    case DriveOrder::enable:
      disabled_ = false;
      brake_ = Brake::by_itself;
      break;
    case DriveOrder::disable:
      disabled_ = true;
      seeking_ = false;
      brake_ = Brake::by_itself;
      break;
    case DriveOrder::reset: {
      if (code_ == 0) break;
      const bool board_too = board_.bitten() || board_.forgot() || (code_ & code_silent) != 0;
      code_ = 0;
      strange_ = 0;
      disabled_ = true;
      return board_too;
    }
    case DriveOrder::home:
      if (wiring_.home == Home::power_on || disabled_ || code_ != 0) break;
      seeking_ = true;
      sought_s_ = 0;
      was_at_switch_ = true;
      if (wiring_.home != Home::home_switch) board_.arm_latch(wiring_.encoder, wiring_.home == Home::probe);
      break;
    case DriveOrder::brake:
      brake_ = Brake::closed;
      break;
    case DriveOrder::release:
      brake_ = Brake::open;
      break;
    case DriveOrder::none:
      break;
  }
  return false;
}

void Axis::found(std::int64_t count) noexcept {
  zero_count_ = count;
  sample_.homed = true;
  seeking_ = false;
  if (wiring_.home != Home::home_switch) board_.disarm_latch(wiring_.encoder);
}

void Axis::seek(double period_s) noexcept {
  sought_s_ += period_s;
  if (wiring_.home == Home::home_switch) {
    const bool at = board_.active(*wiring_.home_switch);
    if (at && !was_at_switch_) return found(encoder_.count());
    was_at_switch_ = at;
  } else if (!board_.latch_waits(wiring_.encoder)) {
    return found(encoder_.extended(board_.latched(wiring_.encoder)));
  }
  if (sought_s_ < wiring_.home_timeout_s) return;
  seeking_ = false;
  code_ |= code_no_zero;
}

double Axis::effort_of(const JointActuation& asked) const noexcept {
  const double ahead_rad = asked.position_rad - sample_.position_rad;
  const double faster_rad_s = asked.velocity_rad_s - velocity_rad_s_;
  switch (asked.mode) {
    case ActuationMode::effort:
      return asked.effort_Nm;
    case ActuationMode::impedance:
      return asked.stiffness_Nm_per_rad * ahead_rad + asked.damping_Nms_per_rad * faster_rad_s + asked.effort_Nm;
    case ActuationMode::position:
      return wiring_.position_gain_Nm_per_rad * ahead_rad + wiring_.velocity_gain_Nms_per_rad * faster_rad_s +
             asked.effort_Nm;
    case ActuationMode::velocity:
      return wiring_.velocity_gain_Nms_per_rad * faster_rad_s + asked.effort_Nm;
    case ActuationMode::off:
      break;
  }
  return 0;
}

bool Axis::plan(const JointActuation& asked, const DriveRequest& order, double period_s) noexcept {
  const bool repair = order.is_new(order_seen_) && carry_out(order.order);
  if (!wiring_.pwm) {
    sample_.drive = code_ != 0 ? DriveState::fault : DriveState::enabled;
    sample_.code = code_;
    return repair;
  }
  if (seeking_) seek(period_s);
  const bool acts = code_ == 0 && !disabled_ && !repair && sample_.sequence > 0 && asked.mode != ActuationMode::off &&
                    is_finite(asked);
  double effort_Nm = 0;
  if (acts) {
    const JointActuation looking{.velocity_rad_s = wiring_.home_rad_s, .mode = ActuationMode::velocity};
    effort_Nm = effort_of(seeking_ ? looking : asked);
    const bool at_low = wiring_.low && board_.active(*wiring_.low);
    const bool at_high = wiring_.high && board_.active(*wiring_.high);
    if ((at_low && effort_Nm < 0) || (at_high && effort_Nm > 0)) effort_Nm = 0;
  }
  const bool enabled = !wiring_.enable || board_.active(*wiring_.enable);
  const double sign = wiring_.pwm_reversed ? -1 : 1;
  const Amplifier::Duty duty = acts ? amplifier_.duty_for(effort_Nm, velocity_rad_s_) : Amplifier::Duty{};
  if (duty.limited) ++limited_;
  board_.set_duty(*wiring_.pwm, sign * duty.duty);
  if (wiring_.enable) board_.set_active(*wiring_.enable, acts);
  const bool open = brake_ == Brake::open || (brake_ == Brake::by_itself && acts && enabled);
  if (wiring_.brake) board_.set_active(*wiring_.brake, open);
  sample_.braked = wiring_.brake && !open;
  sample_.motor_effort_Nm = acts && enabled ? duty.effort_Nm : 0;
  tell_state(acts && enabled);
  return repair;
}

void Axis::tell_state(bool acts) noexcept {
  sample_.code = code_;
  sample_.drive = code_ != 0  ? DriveState::fault
                  : disabled_ ? DriveState::off
                  : seeking_  ? DriveState::homing
                  : acts      ? DriveState::enabled
                              : DriveState::ready;
}

}  // namespace kadans::hostmot2
