// Which servos move which joints, on which serial ports: the fields under plant.dynamixel of the robot's configuration.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control_table.h"
#include "kadans/plant/plant_type.h"

namespace kadans::dynamixel {

struct PortSettings {
  std::string name;
  std::string device;
  std::uint32_t baud = 1'000'000;
  InputProblem place{};  // of its device in the configuration
};

struct ServoSettings {
  std::string drive;  // as plant.drives has it: the joint's, or that of a coupling
  std::string port;
  std::uint32_t id = 1;
  const ServoModel* model = nullptr;
  std::uint32_t zero_pulse = 2048;  // its position when the drive is at 0
  bool reversed = false;            // counts in the opposite direction
  double Nm_per_A = 0;              // 0: the model's, from its stall torque and current
  InputProblem place{};             // in the configuration, for what only the servo shows

  double torque_constant_Nm_per_A() const noexcept { return Nm_per_A > 0 ? Nm_per_A : model->Nm_per_A(); }
};

struct DynamixelSettings {
  std::vector<PortSettings> ports;
  std::vector<ServoSettings> servos;
  double period_s = 0;  // of the bus; 0: the least whole multiple of the control period that all ports can hold
  double watchdog_s = 0.1;
  double usb_latency_s = 0.001;
  double patience_s = 0.02;

  // Lists the fields; refuses what does not fit together.
  void fields(PlantFields& f);
};

std::string milliseconds(std::int64_t ns);  // "0.35 ms"

// What one cycle of a port needs.
struct CycleNeed {
  std::size_t servos = 0;
  std::size_t bytes = 0;       // there and back
  std::int64_t wire_ns = 0;    // what these take on the wire
  std::int64_t needed_ns = 0;  // with what the USB adapter adds
};
// Throws std::invalid_argument when the port has no servos.
CycleNeed cycle_need(const DynamixelSettings& settings, const PortSettings& port);
// What helps or hinders the servos on this machine: the device of each port, its latency timer, and the period that its
// cycle can hold. Nothing is opened.
std::vector<PlantType::Finding> examine_ports(const DynamixelSettings& settings, std::int64_t control_period_ns);
// The period of the bus for this control period.
std::int64_t bus_period_ns(const DynamixelSettings& settings, std::int64_t control_period_ns);

}  // namespace kadans::dynamixel
