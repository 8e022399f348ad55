// A robot of Dynamixel servos, on one serial port or several.
//
// Each port has a thread of its own, which runs a cycle in each period of the bus: the control thread never waits for a
// servo. `read` takes the newest reading of each, with the time at which it was taken, on CLOCK_MONOTONIC, the clock of
// the frames; `write` leaves the actuation for the next cycle. So an actuation waits for up to one period of the bus.
//
// In virtual time there are no threads: whoever steps the time calls run_cycles().
//
// Safe state: the servos' own watchdogs stop them when no packet came for watchdog_s; close() takes their torque.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kadans/exchange/latest.h"
#include "kadans/plant/plant_type.h"
#include "port_cycle.h"

namespace kadans::dynamixel {

class DynamixelPlant final : public Plant {
 public:
  enum class Threads : bool { none, own };

  // One serial port for each of settings.ports, in their order; none: those of the system are opened in open(). Throws
  // InputError when the robot's drives and the servos do not fit.
  DynamixelPlant(DynamixelSettings settings, PlantSite site, std::vector<std::unique_ptr<SerialPort>> ports,
                 Threads threads);
  ~DynamixelPlant() override;  // closes

  bool open(bool (*give_up)() noexcept = nullptr) override;
  void close() noexcept override;
  void declare_signals(SignalTable& table) const override;
  std::vector<PlantCount> link_counts() const override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;

  // Without threads: a cycle of each port.
  void run_cycles() noexcept;
  std::int64_t period_ns() const noexcept { return period_ns_; }

 private:
  struct Port;

  DynamixelSettings settings_;
  PlantSite site_;
  std::vector<std::unique_ptr<SerialPort>> serial_;
  Threads threads_;
  std::int64_t period_ns_;
  std::vector<std::unique_ptr<Port>> ports_;
  bool open_ = false;
  ActuationFrame drives_;
  PortCounts counts_;    // of all ports, as of the last read
  double age_ms_ = 0;    // of the oldest reading
  double cycle_ms_ = 0;  // of the slowest port
};

}  // namespace kadans::dynamixel
