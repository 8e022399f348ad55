// A model that is driven through a bus: the driver, the bytes on the wire and the emulated drives, all on virtual time
// and on one thread. So the same seed gives the same bytes at the same times, faults of the bus and its drives among
// them. What nothing on the bus measures comes from the model.
//
// One owner, one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "kadans/plant/emulated_drives.h"
#include "kadans/plant/world.h"

namespace kadans {

// What passed on a wire: bytes, and when.
class WireHash {
 public:
  void pass(std::span<const std::uint8_t> bytes, std::int64_t now_ns) noexcept {
    hash_.add(now_ns);
    for (const std::uint8_t byte : bytes) hash_.add(byte);
  }
  std::uint64_t value() const noexcept { return hash_.value(); }

 private:
  StateHash hash_;
};

class WiredWorld : public WorldAround {
 public:
  // Finds the drives, as at the start of a run. Throws InputError. Without it the first step does so.
  bool open(bool (*give_up)() noexcept = nullptr) final;
  void start() { (void)open(); }
  void declare_signals(SignalTable& table) const final { plant().declare_signals(table); }
  std::vector<PlantCount> link_counts() const final { return plant().link_counts(); }
  void read(SensorFrame& sensors) noexcept final;
  void write(const ActuationFrame& actuation) noexcept final;
  void step(std::int64_t dt_ns) final;
  void hash(StateHash& hash) const noexcept final;  // with all that passed on the wire
  // By this world's time. Throws std::invalid_argument.
  void plan_faults(const std::vector<EmulatedFault>& faults) { faults_.add(faults, drives()); }

  bool silent = false;  // the driver hangs

 protected:
  explicit WiredWorld(std::unique_ptr<World> model) : WorldAround(std::move(model)) {}
  WorldRobot& inner() noexcept { return robot_; }
  std::int64_t time_ns() const noexcept { return time_ns_; }

  virtual Plant& plant() const noexcept = 0;  // the driver
  virtual EmulatedDrives& drives() noexcept = 0;
  virtual void set_time(std::int64_t now_ns) noexcept = 0;  // of the wire
  virtual bool open_driver(bool (*give_up)() noexcept) = 0;
  virtual void take(SensorFrame& sensors) noexcept = 0;  // puts what the driver read over what the model's sensors show
  virtual void begin_step() = 0;
  virtual void end_step() = 0;
  virtual std::uint64_t passed() const noexcept = 0;  // a hash of what passed on the wire

 private:
  FaultPlan faults_;
  std::int64_t time_ns_ = 0;
  bool started_ = false;
};

}  // namespace kadans
