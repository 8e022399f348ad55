// A bus with drives, and an IMU on a serial line beside it: one plant.
//
// A thread of its own reads the line; read() takes the newest reading, with the time at which it was measured. When the
// line falls silent, so does the IMU in the frames, and the safety layer acts on it; the drives go on.
#pragma once

#include <memory>

#include "kadans/exchange/latest.h"
#include "kadans/plant/bus_thread.h"
#include "kadans/plant/plant.h"
#include "serial_imu.h"

namespace kadans::imu {

class ImuPlant final : public Plant {
 public:
  enum class Threads : bool { none, own };  // none: on virtual time, read() reads the line itself

  // Without a port: that of the system, opened in open(). `to_base` turns the device's axes into the base's.
  ImuPlant(std::unique_ptr<Plant> bus, SerialImuSettings settings, const Quat& to_base,
           std::unique_ptr<SerialPort> port = nullptr, Threads threads = Threads::own);
  ~ImuPlant() override;  // closes

  void declare_signals(SignalTable& table) const override;
  bool open(bool (*give_up)() noexcept) override;
  void close() noexcept override;
  std::vector<PlantCount> link_counts() const override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override { bus_->write(actuation); }

 private:
  std::unique_ptr<Plant> bus_;
  SerialImuSettings settings_;
  Quat to_base_;
  std::unique_ptr<SerialPort> port_;
  Threads threads_;
  std::unique_ptr<SerialImu> imu_;
  Latest<ImuNews> news_;
  ImuCounts counts_;
  double age_ms_ = 0;
  BusThread thread_;
};

}  // namespace kadans::imu
