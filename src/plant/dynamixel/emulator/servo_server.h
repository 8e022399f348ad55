// Serves a modelled robot's servos on pseudo-terminals (drive_server.h). The baud rate is the one that the other end
// has set its terminal to: at another one than the servos' they understand nothing.
#pragma once

#include <string>
#include <vector>

#include "emulated_robot.h"
#include "plant/drive_server.h"

namespace kadans::dynamixel {

class ServoServer final : public DriveServer {
 public:
  // Makes a link to a terminal at `listen`; with several ports one at `listen`-NAME for each. Throws InputError.
  ServoServer(const DynamixelSettings& settings, const PlantSite& site, const std::string& listen);
  ~ServoServer() override;

  std::string peer_name() const override { return "whoever opened " + listen_; }
  std::vector<PlantCount> link_counts() const override;

 private:
  std::vector<int> descriptors() const override { return masters_; }
  std::int64_t serve_bus(std::int64_t now_ns) noexcept override;
  std::uint64_t heard() const noexcept override;
  EmulatedDrives& drives() noexcept override { return robot_; }
  void open_terminal(const std::string& link);

  std::string listen_;
  std::vector<int> masters_, slaves_;  // a slave of our own keeps the terminal alive while nobody else has it open
  std::vector<std::string> links_;
  EmulatedRobot robot_;
};

}  // namespace kadans::dynamixel
