// A robot of Unitree's at its low level, over DDS.
//
// A thread of the bus takes each state when it comes and sends a command each period: the control thread never calls
// DDS, which allocates and locks. `read` copies the newest state, with the time at which it came, on CLOCK_MONOTONIC;
// `write` leaves the actuation for the next command. So an actuation waits for up to one period.
//
// On virtual time there is no thread: whoever steps the time calls run_cycle().
//
// Safe state: close() lets the motors damp for damping_s, then gives them no torque. What a robot does when its host
// falls silent is the robot's own; the emulated one damps after watchdog_s.
#pragma once

#include <memory>

#include "kadans/exchange/latest.h"
#include "kadans/plant/bus_thread.h"
#include "kadans/plant/plant_type.h"
#include "low_driver.h"

namespace unitree {

class UnitreePlant final : public kadans::Plant {
 public:
  // Without a link, open() makes one of DDS, and a thread of its own. Throws InputError when the robot's drives and its
  // motors do not fit.
  UnitreePlant(const Settings& settings, kadans::PlantSite site, std::unique_ptr<DriverLink> link = nullptr);
  ~UnitreePlant() override;  // closes

  bool open(bool (*give_up)() noexcept = nullptr) override;
  void close() noexcept override;
  void declare_signals(kadans::SignalTable& table) const override;
  std::vector<kadans::PlantCount> link_counts() const override;

  void read(kadans::SensorFrame& sensors) noexcept override;
  void write(const kadans::ActuationFrame& actuation) noexcept override;

  // Without a thread.
  void run_cycle() noexcept;

 private:
  [[noreturn]] void fail_without_state(const std::string& other_kind) const;
  void loop() noexcept;

  Settings settings_;
  kadans::PlantSite site_;
  std::vector<MotorSettings> motors_;
  std::vector<std::size_t> feet_;  // the place of each in foot_force; none: they are not read
  bool own_thread_;
  std::unique_ptr<DriverLink> link_;
  std::unique_ptr<LowDriver> driver_;
  kadans::Latest<kadans::ActuationFrame> actuation_;
  kadans::Latest<LowSample> sample_;
  kadans::ActuationFrame drives_;
  Counts counts_;      // as of the last read
  double age_ms_ = 0;  // of the newest state
  kadans::BusThread thread_;
};

}  // namespace unitree
