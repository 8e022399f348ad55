// Serves an emulated robot on DDS, in real time, to whatever program speaks the low level.
//
// A session begins when somebody reads rt/lowstate or could write rt/lowcmd. The model's time begins with the first
// torque, so that the robot does not fall while its peer looks for it. The session ends when nobody is there any more,
// or a second after the last command. Several may write commands: each is obeyed, as a robot does.
//
// In step with its peer, the model's time passes with the commands that come, a period each.
//
// Threads: one at a time; DDS has its own.
#pragma once

#include <string>

#include "dds_link.h"
#include "emulated_robot.h"

namespace unitree {

class UnitreeEmulator final : public kadans::PlantEmulator {
 public:
  // Throws InputError.
  UnitreeEmulator(const Settings& settings, const kadans::PlantSite& site);

  bool await(int milliseconds) noexcept override;
  bool beat(kadans::World& world, std::uint32_t periods) override;
  bool step_with_peer() noexcept override { return in_step_ = true; }
  void plan_faults(const std::vector<kadans::EmulatedFault>& faults) override { faults_.add(faults, robot_); }
  std::string peer_name() const override { return place_; }
  const Session& session() const noexcept override { return session_; }
  std::vector<kadans::PlantCount> link_counts() const override;

 private:
  void hear_all() noexcept;
  void write_beside() noexcept;
  std::uint32_t due(std::uint32_t periods) noexcept;
  bool is_over(std::int64_t beat_ns) noexcept;

  std::string place_;
  std::int64_t period_ns_;
  std::uint32_t divisor_;  // control periods in one of the bus
  EmulatedRobot robot_;
  kadans::FaultPlan faults_;
  DdsDomain domain_;
  dds_entity_t commands_, states_, second_;
  Packet packet_;
  Session session_;
  bool in_step_ = false, time_runs_ = false, driven_ = false, damped_ = false;
  std::uint32_t heard_ = 0;  // commands since the last beat
  std::uint32_t told_ = 0;   // periods since the last state
  std::int64_t time_ns_ = 0, silent_ns_ = 0;
};

}  // namespace unitree
