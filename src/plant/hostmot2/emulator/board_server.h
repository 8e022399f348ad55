// Serves a modelled robot's boards as UDP on this machine's addresses (drive_server.h).
#pragma once

#include <string>
#include <vector>

#include "emulated_machine.h"
#include "plant/drive_server.h"
#include "plant/socket_address.h"
#include "signal/owned_descriptor.h"

namespace kadans::hostmot2 {

class BoardServer final : public DriveServer {
 public:
  // Each board listens at its address. Throws InputError.
  BoardServer(const HostMot2Settings& settings, const PlantSite& site);
  ~BoardServer() override;

  std::string peer_name() const override { return "whoever speaks LBP16 there"; }

 private:
  std::vector<int> descriptors() const override {
    std::vector<int> numbers;
    for (const OwnedDescriptor& one : sockets_) numbers.push_back(one.number());
    return numbers;
  }
  std::int64_t serve_bus(std::int64_t now_ns) noexcept override;
  std::uint64_t heard() const noexcept override;
  std::uint64_t cycles() const noexcept override;
  std::vector<PlantCount> counts() const override;
  EmulatedDrives& drives() noexcept override { return machine_; }

  EmulatedMachine machine_;
  std::vector<OwnedDescriptor> sockets_;
  std::vector<PeerAddress> peers_;  // who spoke last to each board
};

}  // namespace kadans::hostmot2
