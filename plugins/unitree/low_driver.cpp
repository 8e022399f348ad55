#include "low_driver.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace unitree {
namespace {

using kadans::ActuationMode;
using kadans::DriveOrder;
using kadans::DriveState;

constexpr int states_a_cycle_max = 32;              // a flood of them costs no period
constexpr std::int64_t quiet_ns = 500'000'000;      // so long somebody else must have been silent
constexpr std::uint32_t restart_back_ticks = 1000;  // a clock that goes back by more has begun anew
constexpr int releases = 5;                         // of these commands one will come

}  // namespace

// Short: a fault has 40 characters, and the code's number takes 17 of them.
std::string_view drive_code_words(std::uint32_t code) noexcept {
  if (code == second_writer_code) return "others write rt/lowcmd";
  if (code == restarted_code) return "the robot restarted";
  return "";
}

LowDriver::LowDriver(DriverLink& link, const Settings& settings, std::vector<MotorSettings> motors)
    : link_(link),
      settings_(settings),
      family_(settings.kind->family),
      motors_(std::move(motors)),
      drives_(motors_.size()),
      codes_(motors_.size()) {
  sample_.count = static_cast<std::uint32_t>(motors_.size());
}

bool LowDriver::is_new(std::uint32_t tick) noexcept {
  if (!std::exchange(began_, true)) return true;
  const std::uint32_t on = tick - tick_, back = tick_ - tick;  // the clock wraps around
  if (on != 0 && on < back) return true;
  if (back <= restart_back_ticks) {
    ++sample_.counts.stale;
    return false;
  }
  ++sample_.counts.restarts;
  if (drives_robot_) latched_ = restarted_code;
  return true;
}

bool LowDriver::take() noexcept {
  bool news = false;
  for (int i = 0; i < states_a_cycle_max && link_.take(packet_); ++i) {
    State state;
    const Verdict verdict = decode(family_, packet_, settings_.checksums, state);
    if (verdict == Verdict::corrupt) {
      ++sample_.counts.corrupt;
      continue;
    }
    if (!is_new(state.tick)) continue;
    if (verdict == Verdict::not_finite) ++sample_.counts.not_finite;
    tick_ = state.tick;
    use(state);
    news = true;
  }
  return news;
}

void LowDriver::use(const State& state) noexcept {
  const std::int64_t now_ns = link_.now_ns();
  state_ = state;
  ++sample_.counts.states;
  sample_.counts.lost = 0;
  double lowest_V = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const MotorState& motor = state.motors[motors_[i].number];
    kadans::JointSample& joint = sample_.joints[i];
    joint.position_rad = joint.motor_position_rad = motor.q;
    joint.motor_effort_Nm = motor.tau;
    joint.temperature_C = motor.temperature_C;
    joint.time_ns = now_ns;
    ++joint.sequence;
    codes_[i] = motor.code;
    sample_.counts.lost += motor.lost;
    if (motor.supply_V > 0 && !(motor.supply_V >= lowest_V)) lowest_V = motor.supply_V;
  }
  std::ranges::copy(state.gyroscope_rad_s, sample_.imu.angular_velocity_rad_s.begin());
  std::ranges::copy(state.accelerometer_m_s2, sample_.imu.acceleration_m_s2.begin());
  sample_.imu.time_ns = now_ns;
  ++sample_.imu.sequence;
  for (std::size_t i = 0; i < state.foot_force.size(); ++i)
    sample_.foot_N[i] = settings_.foot_N_per_count * state.foot_force[i];
  // A robot that does not tell its voltage says 0.
  sample_.supply_V = family_ == Family::hg ? lowest_V
                     : state.supply_V > 0  ? state.supply_V
                                           : std::numeric_limits<double>::quiet_NaN();
  tell_drives();
}

void LowDriver::look_for_others() noexcept {
  const std::uint32_t foreign = link_.foreign_commands();
  sample_.counts.foreign += foreign;
  const std::int64_t now_ns = link_.now_ns();
  if (foreign > 0) foreign_ns_ = now_ns;
  foreign_seen_ = (foreign_seen_ && now_ns - foreign_ns_ < quiet_ns) || foreign > 0;
  if (foreign_seen_ && drives_robot_) latched_ = second_writer_code;
}

void LowDriver::obey(const kadans::DriveRequest& request, Drive& drive) noexcept {
  if (!request.is_new(drive.order_seen)) return;
  if (request.order == DriveOrder::enable) drive.enabled = true;
  if (request.order == DriveOrder::disable) drive.enabled = false;
  if (request.order == DriveOrder::reset && !foreign_seen_) latched_ = 0;
}

MotorCommand LowDriver::command_of(const kadans::JointActuation& asked, const MotorSettings& motor) noexcept {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  MotorCommand is{.mode = motor_on};
  const bool loop = asked.mode == ActuationMode::impedance, position = asked.mode == ActuationMode::position;
  if (asked.mode != ActuationMode::off) is.tau = narrow(asked.effort_Nm);
  if (loop || position) is.q = narrow(asked.position_rad);
  if (loop || position || asked.mode == ActuationMode::velocity) is.dq = narrow(asked.velocity_rad_s);
  if (loop) is.kp = narrow(asked.stiffness_Nm_per_rad);
  if (loop) is.kd = narrow(asked.damping_Nms_per_rad);
  if (position) is.kp = narrow(motor.stiffness_Nm_per_rad);
  if (position || asked.mode == ActuationMode::velocity) is.kd = narrow(motor.damping_Nms_per_rad);
  if (0 * is.q + 0 * is.dq + 0 * is.tau + 0 * is.kp + 0 * is.kd == 0) return is;
  ++sample_.counts.refused;
  return {.mode = motor_on, .kd = narrow(settings_.damping_Nms_per_rad)};
}

void LowDriver::run(const kadans::ActuationFrame& drives) noexcept {
  const std::size_t count = std::min<std::size_t>(drives.joint_count, motors_.size());
  for (std::size_t i = 0; i < count; ++i) drives_robot_ = drives_robot_ || drives.joints[i].mode != ActuationMode::off;
  look_for_others();
  command_ = {.mode_machine = state_.mode_machine};
  for (std::size_t i = 0; i < count; ++i) {
    obey(drives.drives[i], drives_[i]);
    if (drives_[i].enabled) command_.motors[motors_[i].number] = command_of(drives.joints[i], motors_[i]);
  }
  tell_drives();
  if (drives_robot_ && latched_ == 0) send();
}

void LowDriver::send() noexcept {
  encode(family_, command_, packet_);
  ++(link_.send(packet_) ? sample_.counts.commands : sample_.counts.unsent);
}

void LowDriver::tell_drives() noexcept {
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    kadans::JointSample& joint = sample_.joints[i];
    joint.code = latched_ != 0 ? latched_ : codes_[i];
    joint.drive = joint.code != 0 ? DriveState::fault : drives_[i].enabled ? DriveState::enabled : DriveState::ready;
  }
}

void LowDriver::release() noexcept {
  look_for_others();
  if (!drives_robot_ || latched_ != 0) return;  // it is not ours
  const auto periods = static_cast<int>(settings_.damping_s / settings_.period_s);
  std::int64_t due_ns = link_.now_ns();
  for (int i = 0; i < periods + releases; ++i) {
    (void)take();
    look_for_others();
    if (latched_ != 0) return;
    command_ = {.mode_machine = state_.mode_machine};
    for (const MotorSettings& motor : motors_) {
      if (i < periods)
        command_.motors[motor.number] = {.mode = motor_on, .kd = static_cast<float>(settings_.damping_Nms_per_rad)};
    }
    send();
    due_ns += settings_.period_ns();
    while (link_.now_ns() < due_ns) {
      link_.wait(due_ns);
      (void)take();
    }
  }
}

}  // namespace unitree
