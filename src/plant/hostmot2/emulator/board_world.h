// A model that is driven through HostMot2 boards, on virtual time (wired_world.h).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "emulated_machine.h"
#include "kadans/plant/wired_world.h"
#include "plant/hostmot2/hostmot2_plant.h"
#include "plant/hostmot2/lbp_link.h"

namespace kadans::hostmot2 {

class VirtualCable final : public DatagramPort {
 public:
  explicit VirtualCable(EmulatedWire& wire) : wire_(wire) {}
  bool send(Octets datagram) noexcept override;
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override;
  void await(std::int64_t until_ns) noexcept override;
  std::int64_t now_ns() const noexcept override { return now_; }
  void set(std::int64_t now) noexcept { now_ = now; }
  std::uint64_t passed() const noexcept { return passed_.value(); }
  std::size_t sent = 0, received = 0;  // bytes of the last datagrams

  // The board gets a datagram, and the host the reply, with answer(): until then neither end allocates.
  bool holds = false;
  void answer();

 private:
  EmulatedWire& wire_;
  std::array<std::uint8_t, 2048> held_{};
  std::size_t answered_ = 0;
  std::int64_t now_ = -1'000'000'000'000;
  WireHash passed_;
};

// An emulated board's registers as a mapped file, as a PCI card's are. What the host wrote there is seen at the next
// take(), register by register in the order of their addresses; show() puts there what it reads. The host may write
// meanwhile.
class RegisterFile {
 public:
  RegisterFile(EmulatedBoard& board, const std::string& path);  // makes the file; throws InputError
  ~RegisterFile();
  RegisterFile(const RegisterFile&) = delete;
  RegisterFile& operator=(const RegisterFile&) = delete;

  void take() noexcept;
  void show() noexcept;

 private:
  EmulatedBoard& board_;
  volatile std::uint32_t* registers_ = nullptr;
  std::vector<std::uint32_t> shown_;
};

class BoardWorld final : public WiredWorld {
 public:
  // `there`: what the boards are. Cards on PCI are files that this object makes. Throws InputError.
  BoardWorld(std::unique_ptr<World> model, const HostMot2Settings& settings, const HostMot2Settings& there,
             const PlantSite& site);

  HostMot2Plant& driver() noexcept { return *plant_; }
  EmulatedMachine& machine() noexcept { return machine_; }
  VirtualCable& cable(std::size_t number) noexcept { return *cables_[number]; }

 private:
  Plant& plant() const noexcept override { return *plant_; }
  EmulatedDrives& drives() noexcept override { return machine_; }
  void set_time(std::int64_t now_ns) noexcept override;
  bool open_driver(bool (*give_up)() noexcept) override { return plant_->open(give_up); }
  void take(SensorFrame& sensors) noexcept override;
  void begin_step() override;
  void end_step() override;
  std::uint64_t passed() const noexcept override;

  EmulatedMachine machine_;
  bool wired_feet_;
  std::vector<VirtualCable*> cables_;
  std::vector<std::unique_ptr<RegisterFile>> files_;
  std::unique_ptr<HostMot2Plant> plant_;
};

}  // namespace kadans::hostmot2
