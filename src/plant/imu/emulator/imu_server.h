// Serves a modelled robot's IMU on a pseudo-terminal, in real time, beside an emulator of its drives.
//
// Threads: a thread of its own serves the terminal from the beginning to the end, sessions or none; the rest as of the
// emulator beside.
#pragma once

#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "emulated_imu.h"
#include "kadans/plant/plant_type.h"
#include "plant/imu/settings.h"
#include "plant/serial/pseudo_terminal.h"

namespace kadans::imu {

class ImuServer final : public PlantEmulator {
 public:
  // Makes a link to a terminal at `link`. Throws InputError.
  ImuServer(std::unique_ptr<PlantEmulator> drives, const SerialImuSettings& settings, const Quat& to_base,
            const std::string& link);

  void look(World& world) override { drives_->look(world); }
  bool await(int milliseconds) noexcept override { return drives_->await(milliseconds); }
  bool beat(World& world, std::uint32_t periods) override;
  bool step_with_peer() noexcept override { return false; }  // its time is the clock's
  // Those of "imu" are its own: bytes_lost, bytes_corrupt, cable_out.
  void plan_faults(const std::vector<EmulatedFault>& faults) override;
  std::string peer_name() const override { return drives_->peer_name(); }
  const Session& session() const noexcept override { return drives_->session(); }
  std::vector<PlantCount> link_counts() const override;

 private:
  void serve(const std::stop_token& stop) noexcept;

  std::unique_ptr<PlantEmulator> drives_;
  std::vector<EmulatedFault> faults_;
  Quat to_base_;
  PseudoTerminal terminal_;
  mutable std::mutex mutex_;  // of the device
  EmulatedImu device_;
  std::jthread thread_;  // last: it uses all others
};

}  // namespace kadans::imu
