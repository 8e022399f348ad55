#include "emulated_robot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace unitree {
namespace {

using kadans::ActuationMode;

constexpr float temperature_C = 35, supply_go_V = 29, supply_hg_V = 54;

using Of = kadans::EmulatedFaultKind::Of;
constexpr kadans::EmulatedFaultKind fault_kinds[] = {
    {"cable_out", Of::nothing, ""},
    {"states_lost", Of::nothing, "share of the states"},
    {"states_corrupt", Of::nothing, "share of the states"},
    {"states_again", Of::nothing, "share of the states"},
    {"second_writer", Of::nothing, ""},
    {"robot_restarts", Of::nothing, ""},
    {"drive_tripped", Of::drive, "the motor's code"},
    {"drive_hot", Of::drive, "its temperature, C"},
    {"drive_not_finite", Of::drive, ""},
};

// What a machine says of itself in mode_machine, as the maker's simulator has it: of a G1 with all joints, or with 23.
std::uint8_t machine_of(const RobotKind& kind, std::size_t joints) {
  return kind.name == "g1" ? (joints >= kind.joints.size() ? 5 : 4) : 1;
}

}  // namespace

EmulatedRobot::EmulatedRobot(const Settings& settings, const kadans::PlantSite& site)
    : motors_(motors_of(settings, site)),
      family_(settings.kind->family),
      shafts_(site),
      foot_N_per_count_(settings.foot_N_per_count > 0 ? settings.foot_N_per_count : 1),
      damping_Nms_per_rad_(settings.damping_Nms_per_rad),
      watchdog_ns_(static_cast<std::int64_t>(1e9 * settings.watchdog_s)),
      tripped_(motors_.size()),
      not_finite_(motors_.size()),
      random_(site.seed, "unitree") {
  feet_.fill(kadans::max_feet);
  for (std::size_t i = 0; i < site.layout.feet.size(); ++i) {
    const std::size_t place = place_of_foot(site.layout.feet[i]);
    if (place < feet_max) feet_[place] = i;
  }
  state_.mode_machine = machine_of(*settings.kind, motors_.size());
}

void EmulatedRobot::check(const kadans::EmulatedFault& fault) const {
  check_fault(fault, fault_kinds, shafts_.drives(), {});
}

void EmulatedRobot::befall(const kadans::EmulatedFault& fault, bool begins) noexcept {
  const double size = begins ? fault.size : 0;
  if (fault.kind == "cable_out") cable_out_ = begins;
  if (fault.kind == "states_lost") lost_ = size;
  if (fault.kind == "states_corrupt") corrupt_ = size;
  if (fault.kind == "states_again") again_ = size;
  if (fault.kind == "second_writer") second_writer_ = begins;
  if (fault.kind == "robot_restarts" && begins) {
    command_ = {};
    clock_ns_ = 0;
  }
  const std::size_t joint = shafts_.place(fault.of);
  if (joint == motors_.size()) return;
  if (fault.kind == "drive_tripped") tripped_[joint] = static_cast<std::uint32_t>(size);
  if (fault.kind == "drive_hot")
    state_.motors[motors_[joint].number].temperature_C = begins ? static_cast<float>(size) : temperature_C;
  if (fault.kind == "drive_not_finite") not_finite_[joint] = begins;
}

void EmulatedRobot::look(kadans::WorldRobot& robot) {
  shafts_.look(robot);
  const kadans::SensorFrame& sensors = shafts_.sensors();
  const auto narrow = [](double value) { return static_cast<float>(value); };
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    MotorState& motor = state_.motors[motors_[i].number];
    motor.mode = command_.motors[motors_[i].number].mode;
    motor.q = not_finite_[i] ? std::numeric_limits<float>::quiet_NaN() : narrow(shafts_.position_rad(i));
    motor.dq = narrow(shafts_.velocity_rad_s(i));
    motor.tau = narrow(shafts_.effort_Nm(i));
    motor.code = tripped_[i];
    motor.supply_V = supply_hg_V;
    if (motor.temperature_C == 0) motor.temperature_C = temperature_C;
  }
  state_.supply_V = supply_go_V;
  std::ranges::transform(sensors.imu.angular_velocity_rad_s, state_.gyroscope_rad_s.begin(), narrow);
  std::ranges::transform(sensors.imu.acceleration_m_s2, state_.accelerometer_m_s2.begin(), narrow);
  const auto [w, x, y, z] = robot.truth().base.orientation;
  state_.quaternion = {narrow(w), narrow(x), narrow(y), narrow(z)};
  state_.rpy_rad = {narrow(std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))),
                    narrow(std::asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0))),
                    narrow(std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))};
  for (std::size_t place = 0; place < feet_.size(); ++place) {
    if (feet_[place] >= sensors.foot_count) continue;
    double force_N = 0;
    for (const double corner_N : sensors.feet[feet_[place]].force_N) force_N += corner_N;
    state_.foot_force[place] = static_cast<std::int16_t>(std::clamp(force_N / foot_N_per_count_, 0.0, 32767.0));
  }
}

void EmulatedRobot::drive(kadans::WorldRobot& robot) {
  const bool damps = any_watchdog_tripped();
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    const MotorCommand& asked = command_.motors[motors_[i].number];
    kadans::JointActuation does;
    if (asked.mode != 0 && tripped_[i] == 0) {
      does.mode = ActuationMode::impedance;
      does.damping_Nms_per_rad = damps ? damping_Nms_per_rad_ : static_cast<double>(asked.kd);
    }
    if (does.mode != ActuationMode::off && !damps) {
      does.effort_Nm = asked.tau;
      does.position_rad = asked.kp > 0 ? static_cast<double>(asked.q) : 0;
      does.velocity_rad_s = asked.kd > 0 ? static_cast<double>(asked.dq) : 0;
      does.stiffness_Nm_per_rad = asked.kp;
    }
    shafts_.set(i, does);
  }
  shafts_.drive(robot);
}

void EmulatedRobot::pass(std::int64_t dt_ns) noexcept {
  clock_ns_ += dt_ns;
  silent_ns_ += dt_ns;
}

void EmulatedRobot::switch_power() noexcept {
  command_ = {};
  heard_ = false;
  silent_ns_ = 0;
  shafts_.rest();
}

bool EmulatedRobot::takes(const MotorCommand& motor) const noexcept {
  if (motor.mode == 0) return true;
  // q and dq that no gain uses may be anything: the maker's own programs write 2.146e9 and 16000 there.
  return motor.kp >= 0 && motor.kp <= 1e4F && motor.kd >= 0 && motor.kd <= 1e4F && std::abs(motor.tau) <= 1e4F &&
         (motor.kp == 0 || std::abs(motor.q) <= 1e3F) && (motor.kd == 0 || std::abs(motor.dq) <= 1e5F);
}

bool EmulatedRobot::hear(const Packet& packet) noexcept {
  if (cable_out_) return false;
  Command command;
  switch (decode(family_, packet, command)) {
    case Verdict::corrupt:
      ++counts_.corrupt;
      return false;
    case Verdict::foreign:
      ++counts_.foreign;
      return false;
    case Verdict::not_finite:
      ++counts_.refused;
      return false;
    case Verdict::good:
      break;
  }
  if (family_ == Family::hg && (command.mode_machine != state_.mode_machine || command.mode_pr != 0)) {
    ++counts_.foreign;
    return false;
  }
  for (const MotorSettings& motor : motors_) {
    if (takes(command.motors[motor.number])) continue;
    ++counts_.refused;
    return false;
  }
  command_ = command;
  silent_ns_ = 0;
  heard_ = true;
  ++counts_.commands;
  return true;
}

bool EmulatedRobot::tell(Packet& packet) noexcept {
  if (cable_out_ || random_.uniform() < lost_) return false;
  if (!(random_.uniform() < again_)) state_.tick = static_cast<std::uint32_t>(clock_ns_ / 1'000'000);
  encode(family_, state_, packet);
  if (random_.uniform() < corrupt_) packet.words[packet.count / 2] ^= 0x00100000U;
  ++counts_.states;
  return true;
}

void EmulatedRobot::second_command(Packet& packet) const noexcept {
  Command command{.mode_machine = state_.mode_machine};
  for (const MotorSettings& motor : motors_)
    command.motors[motor.number] = {.mode = motor_on, .kd = static_cast<float>(damping_Nms_per_rad_)};
  encode(family_, command, packet);
}

bool EmulatedRobot::any_torque() const noexcept {
  return std::ranges::any_of(motors_, [&](const MotorSettings& motor) {
    const MotorCommand& asked = command_.motors[motor.number];
    return asked.mode != 0 && (asked.kp != 0 || asked.kd != 0 || asked.tau != 0);
  });
}

}  // namespace unitree
