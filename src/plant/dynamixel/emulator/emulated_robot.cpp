#include "emulated_robot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kadans::dynamixel {
namespace {

constexpr double supply_V = 12, supply_Ohm = 0.15;

std::uint8_t code_of_baud(std::uint32_t baud) {
  switch (baud) {
    case 9600:
      return 0;
    case 57'600:
      return 1;
    case 115'200:
      return 2;
    case 1'000'000:
      return 3;
    case 2'000'000:
      return 4;
    case 3'000'000:
      return 5;
    case 4'000'000:
      return 6;
    default:
      return 7;
  }
}

}  // namespace

EmulatedRobot::EmulatedRobot(const DynamixelSettings& settings, const PlantSite& site, std::uint64_t seed)
    : site_(site) {
  std::vector<std::string> drives = site.layout.joints;
  for (const Transmission& transmission : site.transmissions) {
    for (std::size_t i = 0; i < transmission.drives().size(); ++i)
      drives[transmission.joints()[i]] = transmission.drives()[i];
  }
  const auto latency_ns = static_cast<std::int64_t>(0.5e9 * settings.usb_latency_s);
  for (const PortSettings& port : settings.ports) {
    buses_.push_back(std::make_unique<EmulatedBus>(latency_ns, seed + buses_.size()));
    for (const ServoSettings& is : settings.servos) {
      if (is.port != port.name) continue;
      const ServoModel& model = *is.model;
      const auto joint = static_cast<std::size_t>(std::ranges::find(drives, is.drive) - drives.begin());
      wired_.push_back({buses_.size() - 1, buses_.back()->servos.size(), joint});
      buses_.back()->servos.emplace_back(
          EmulatedServo::Settings{.id = static_cast<std::uint8_t>(is.id),
                                  .model = model.number,
                                  .firmware = 48,
                                  .baud_code = code_of_baud(port.baud),
                                  .zero_pulse = static_cast<int>(is.zero_pulse),
                                  .reversed = is.reversed,
                                  .Nm_per_A = is.Nm_per_A > 0 ? is.Nm_per_A : model.stall_Nm / model.stall_A,
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
  std::array<double, max_joints> position_rad{}, effort_Nm{};
  for (std::size_t i = 0; i < sensors_.joint_count; ++i) {
    position_rad[i] = sensors_.joints[i].motor_position_rad;
    effort_Nm[i] = sensors_.joints[i].motor_effort_Nm;
  }
  for (const Transmission& transmission : site_.transmissions) {
    const std::vector<std::size_t>& joints = transmission.joints();
    const std::size_t a = joints[0], b = joints[transmission.coupled() ? 1 : 0];
    const Transmission::Pair at = transmission.drive_position_rad({position_rad[a], position_rad[b]});
    const Transmission::Pair by = transmission.drive_effort_Nm({effort_Nm[a], effort_Nm[b]});
    position_rad[a] = at[0];
    effort_Nm[a] = by[0];
    if (!transmission.coupled()) continue;
    position_rad[b] = at[1];
    effort_Nm[b] = by[1];
  }
  const double dt_s = seconds_between(last_ns_, sensors_.time_ns);
  double current_A = 0;
  for (const Wired& w : wired_) current_A += buses_[w.bus]->servos[w.servo].current_A();
  for (const Wired& w : wired_) {
    const double velocity_rad_s = dt_s > 0 ? (position_rad[w.joint] - last_rad_[w.joint]) / dt_s : 0;
    buses_[w.bus]->servos[w.servo].stands(position_rad[w.joint], velocity_rad_s, effort_Nm[w.joint],
                                          supply_V - supply_Ohm * current_A);
    last_rad_[w.joint] = position_rad[w.joint];
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
