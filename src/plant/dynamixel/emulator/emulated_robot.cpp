#include "emulated_robot.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kadans::dynamixel {
namespace {

constexpr EmulatedFaultKind servo_faults[] = {
    {"bytes_lost", EmulatedFaultKind::Of::line, "share of the bytes"},
    {"bytes_corrupt", EmulatedFaultKind::Of::line, "share of the bytes"},
    {"cable_out", EmulatedFaultKind::Of::line, ""},
    {"drive_reboots", EmulatedFaultKind::Of::drive, ""},
    {"drive_hot", EmulatedFaultKind::Of::drive, "its temperature, C"},
    {"drive_zero", EmulatedFaultKind::Of::drive, "by which it is wrong, rad"},
    {"drive_gone", EmulatedFaultKind::Of::drive, ""},
    {"drive_tripped", EmulatedFaultKind::Of::drive, "bits of the register Hardware Error Status"},
};

constexpr double rad_per_count = 2 * 3.14159265358979 / 4096;
constexpr double supply_V = 12, supply_Ohm = 0.15;

std::uint8_t code_of_baud(std::uint32_t baud) {
  return static_cast<std::uint8_t>(std::ranges::find(EmulatedServo::rates, baud) - EmulatedServo::rates.begin());
}

}  // namespace

EmulatedRobot::EmulatedRobot(const DynamixelSettings& settings, const PlantSite& site, std::uint64_t seed)
    : shafts_(site) {
  const auto latency_ns = static_cast<std::int64_t>(0.5e9 * settings.usb_latency_s);
  for (const PortSettings& port : settings.ports) {
    ports_.push_back(port.name);
    buses_.push_back(std::make_unique<EmulatedBus>(latency_ns, seed + buses_.size()));
    for (const ServoSettings& is : settings.servos) {
      if (is.port != port.name) continue;
      const ServoModel& model = *is.model;
      wired_.push_back({buses_.size() - 1, buses_.back()->servos.size(), shafts_.place(is.drive)});
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
}

EmulatedServo& EmulatedRobot::servo(std::size_t joint) noexcept {
  const auto found = std::ranges::find(wired_, joint, &Wired::joint);
  return buses_[found->bus]->servos[found->servo];
}

void EmulatedRobot::look(WorldRobot& robot) {
  shafts_.look(robot);
  double current_A = 0;
  for (const Wired& w : wired_) current_A += buses_[w.bus]->servos[w.servo].current_A();
  for (const Wired& w : wired_) {
    buses_[w.bus]->servos[w.servo].stands(shafts_.position_rad(w.joint), shafts_.velocity_rad_s(w.joint),
                                          shafts_.effort_Nm(w.joint), supply_V - supply_Ohm * current_A);
  }
}

void EmulatedRobot::drive(WorldRobot& robot) {
  for (const Wired& w : wired_) shafts_.set(w.joint, buses_[w.bus]->servos[w.servo].drives());
  shafts_.drive(robot);
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
  shafts_.rest();
}

void EmulatedRobot::check(const EmulatedFault& fault) const {
  check_fault(fault, servo_faults, shafts_.drives(), ports_);
}

void EmulatedRobot::befall(const EmulatedFault& fault, bool begins) noexcept {
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    if (!hits(fault, i)) continue;
    if (fault.kind == "bytes_lost") buses_[i]->faults.lost = begins ? fault.size : 0;
    if (fault.kind == "bytes_corrupt") buses_[i]->faults.corrupt = begins ? fault.size : 0;
    if (fault.kind != "cable_out") continue;
    for (EmulatedServo& servo : buses_[i]->servos) servo.unplug(begins);
  }
  const std::size_t place = shafts_.place(fault.of);
  if (fault.kind.starts_with("bytes_") || place >= shafts_.drives().size()) return;
  EmulatedServo& its = servo(place);
  if (fault.kind == "drive_gone") its.unplug(begins);
  if (fault.kind == "drive_zero")
    its.shift_zero((begins ? 1 : -1) * static_cast<int>(std::lround(fault.size / rad_per_count)));
  if (!begins) return;
  if (fault.kind == "drive_reboots") its.reboot();
  if (fault.kind == "drive_hot") its.heat_to(static_cast<int>(fault.size));
  if (fault.kind == "drive_tripped") its.break_down(static_cast<std::uint8_t>(fault.size));
}

bool EmulatedRobot::any_torque() const noexcept {
  return std::ranges::any_of(wired_, [&](const Wired& w) { return buses_[w.bus]->servos[w.servo].torque(); });
}

bool EmulatedRobot::any_watchdog_tripped() const noexcept {
  return std::ranges::any_of(wired_, [&](const Wired& w) { return buses_[w.bus]->servos[w.servo].tripped(); });
}

}  // namespace kadans::dynamixel
