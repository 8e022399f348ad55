// Serves a modelled robot's servos on pseudo-terminals, in real time, to whatever program speaks the protocol.
//
// A session begins with the first bytes that somebody sends, and ends after a second without an instruction. Between
// two sessions the servos' power is off. The model's time begins when the first servo gets torque, so that the robot
// does not fall while it is found and set up. The baud rate is the one that the other end has set its terminal to: at
// another one than the servos' they understand nothing.
//
// Threads: await and beat by one thread at a time; a thread of its own serves the buses during a session.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulated_robot.h"
#include "kadans/plant/plant_type.h"

namespace kadans::dynamixel {

class ServoServer final : public PlantEmulator {
 public:
  // Makes a link to a terminal at `listen`; with several ports one at `listen`-NAME for each. Throws InputError.
  ServoServer(const DynamixelSettings& settings, const PlantSite& site, const std::string& listen);
  ~ServoServer() override;

  bool await(int milliseconds) noexcept override;
  bool beat(World& world, std::uint32_t periods) override;
  std::string peer_name() const override { return "whoever opened " + listen_; }
  const Session& session() const noexcept override { return session_; }
  std::vector<PlantCount> link_counts() const override;

 private:
  void serve() noexcept;
  bool end_session() noexcept;
  void open_terminal(const std::string& link);

  std::string listen_;
  std::int64_t period_ns_;
  std::vector<int> masters_, slaves_;  // a slave of our own keeps the terminal alive while nobody else has it open
  std::vector<std::string> links_;
  EmulatedRobot robot_;
  std::mutex mutex_;  // of robot_
  std::thread thread_;
  std::atomic<bool> stop_{false};
  Session session_;
  std::uint64_t heard_ = 0;
  std::int64_t silent_ns_ = 0;
  bool in_session_ = false, time_runs_ = false, tripped_ = false;
};

}  // namespace kadans::dynamixel
