#include "emulated_robot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kadans::dynamixel {
namespace {

constexpr double supply_V = 12, supply_Ohm = 0.15;

std::uint8_t code_of_baud(std::uint32_t baud) {
  return static_cast<std::uint8_t>(std::ranges::find(EmulatedServo::rates, baud) - EmulatedServo::rates.begin());
}

}  // namespace

EmulatedRobot::EmulatedRobot(const DynamixelSettings& settings, const PlantSite& site, std::uint64_t seed)
    : site_(site) {
  const std::vector<std::string> drives = drive_names(site.layout.joints, site.transmissions);
  const auto latency_ns = static_cast<std::int64_t>(0.5e9 * settings.usb_latency_s);
  for (const PortSettings& port : settings.ports) {
    buses_.push_back(std::make_unique<EmulatedBus>(latency_ns, seed + buses_.size()));
    for (const ServoSettings& is : settings.servos) {
      if (is.port != port.name) continue;
      const ServoModel& model = *is.model;
      const auto joint = static_cast<std::size_t>(std::ranges::find(drives, is.drive) - drives.begin());
      wired_.push_back({buses_.size() - 1, buses_.back()->servos.size(), joint});
      buses_.back()->servos.emplace_back(EmulatedServo::Settings{.id = static_cast<std::uint8_t>(is.id),
                                                                 .model = model.number,
                                                                 .firmware = 48,
                                                                 .baud_code = code_of_baud(port.baud),
                                                                 .zero_pulse = static_cast<int>(is.zero_pulse),
                                                                 .reversed = is.reversed,
                                                                 .Nm_per_A = is.torque_constant_Nm_per_A(),
                                                                 .stall_Nm = model.stall_Nm,
                                                                 .no_load_rad_s = model.no_load_rad_s});
    }
  }
  last_rad_.resize(drives.size());
}

EmulatedServo& EmulatedRobot::servo(std::size_t joint) noexcept {
  const auto found = std::ranges::find(wired_, joint, &Wired::joint);
  return buses_[found->bus]->servos[found->servo];
}

void EmulatedRobot::look(WorldRobot& robot) {
  robot.read(sensors_);
  for (const Transmission& transmission : site_.transmissions) transmission.to_drives(sensors_);
  const double dt_s = seconds_between(last_ns_, sensors_.time_ns);
  double current_A = 0;
  for (const Wired& w : wired_) current_A += buses_[w.bus]->servos[w.servo].current_A();
  for (const Wired& w : wired_) {
    const JointSample& drive = sensors_.joints[w.joint];
    const double velocity_rad_s = dt_s > 0 ? (drive.motor_position_rad - last_rad_[w.joint]) / dt_s : 0;
    buses_[w.bus]->servos[w.servo].stands(drive.motor_position_rad, velocity_rad_s, drive.motor_effort_Nm,
                                          supply_V - supply_Ohm * current_A);
    last_rad_[w.joint] = drive.motor_position_rad;
  }
  last_ns_ = sensors_.time_ns;
}

void EmulatedRobot::drive(WorldRobot& robot) {
  drives_.joint_count = sensors_.joint_count;
  for (const Wired& w : wired_) drives_.joints[w.joint] = buses_[w.bus]->servos[w.servo].drives();
  robot.write_drives(drives_);
}

void EmulatedRobot::pass(std::int64_t dt_ns) noexcept {
  for (const auto& bus : buses_) {
    for (EmulatedServo& servo : bus->servos) servo.pass(dt_ns);
  }
}

void EmulatedRobot::switch_power() noexcept {
  for (const auto& bus : buses_) {
    bus->drop_answers();
    for (EmulatedServo& servo : bus->servos) servo.switch_power();
  }
  last_ns_ = 0;
}

bool EmulatedRobot::any_torque() const noexcept {
  return std::ranges::any_of(wired_, [&](const Wired& w) { return buses_[w.bus]->servos[w.servo].torque(); });
}

bool EmulatedRobot::any_watchdog_tripped() const noexcept {
  return std::ranges::any_of(wired_, [&](const Wired& w) { return buses_[w.bus]->servos[w.servo].tripped(); });
}

}  // namespace kadans::dynamixel
