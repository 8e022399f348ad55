// An inertial measurement unit on a serial line of its own, beside a bus with drives: the fields under plant.serial_imu
// of the robot's configuration. Where it sits, and how it is turned, stands under plant.imu, as for a model.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kadans/plant/plant_type.h"

namespace kadans::imu {

// Generations of Xsens' MT protocol: MTData2 of the MTi 10, 100 and later, MTData of the MTi and MTx of 2008.
enum class Protocol : std::uint8_t { mtdata2, mtdata };

struct SerialImuSettings {
  std::string device;  // "": the robot has none
  std::uint32_t baud = 115'200;
  Protocol protocol = Protocol::mtdata2;
  std::string id;  // "037003F8": the device's own; "": any
  std::uint32_t rate_Hz = 200;
  double delay_s = 0.002;  // from the measurement until its message begins
  double patience_s = 0.5;
  InputProblem place{};  // of its device in the configuration

  bool given() const noexcept { return !device.empty(); }
  // Lists the fields; refuses what the line cannot hold.
  void fields(PlantFields& f);
};

// Of a message with a reading.
std::size_t reading_bytes(Protocol protocol) noexcept;

// What helps or hinders it on this machine. Nothing is opened.
std::vector<PlantType::Finding> examine(const SerialImuSettings& settings);

}  // namespace kadans::imu
