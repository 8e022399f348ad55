// A serial line with an emulated IMU at its other end, on virtual time.
#pragma once

#include <array>

#include "emulated_imu.h"
#include "kadans/plant/wired_world.h"
#include "plant/serial/serial_port.h"

namespace kadans::imu {

class ImuLine final : public SerialPort {
 public:
  explicit ImuLine(EmulatedImu& device) : device_(device) {}
  bool send(std::span<const std::uint8_t> bytes) noexcept override;
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override;
  void discard() noexcept override {}
  std::int64_t now_ns() const noexcept override { return now_; }
  void set(std::int64_t now) noexcept { now_ = now; }
  std::uint64_t passed() const noexcept { return passed_.value(); }
  // The device has measured until now; its bytes come with the next receive().
  void fetch();

 private:
  EmulatedImu& device_;
  std::int64_t now_ = 1'000'000;
  std::array<std::uint8_t, 900> ready_{};
  std::size_t fetched_ = 0;
  WireHash passed_;
};

}  // namespace kadans::imu
