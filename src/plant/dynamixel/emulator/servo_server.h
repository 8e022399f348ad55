// Serves a modelled robot's servos on pseudo-terminals (drive_server.h). At another baud rate than
// the servos' they understand nothing.
#pragma once

#include <string>
#include <vector>

#include "emulated_robot.h"
#include "plant/drive_server.h"
#include "plant/serial/pseudo_terminal.h"

namespace kadans::dynamixel {

class ServoServer final : public DriveServer {
 public:
  // Makes a link to a terminal at `listen`; with several ports one at `listen`-NAME for each. Throws InputError.
  ServoServer(const DynamixelSettings& settings, const PlantSite& site, const std::string& listen);
  ~ServoServer() override;

  std::string peer_name() const override { return "whoever opened " + listen_; }

 private:
  std::vector<int> descriptors() const override;
  std::int64_t serve_bus(std::int64_t now_ns) noexcept override;
  std::uint64_t heard() const noexcept override;
  std::uint64_t cycles() const noexcept override;
  std::vector<PlantCount> counts() const override;
  EmulatedDrives& drives() noexcept override { return robot_; }

  std::string listen_;
  std::vector<PseudoTerminal> terminals_;
  EmulatedRobot robot_;
};

}  // namespace kadans::dynamixel
