// A serial line with an emulated IMU at its other end, on virtual time.
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "plant/imu/emulator/emulated_imu.h"
#include "plant/serial/serial_port.h"

namespace kadans::test {

class ImuLine final : public SerialPort {
 public:
  explicit ImuLine(imu::EmulatedImu& device) : device_(device) {}
  bool send(std::span<const std::uint8_t> bytes) noexcept override {
    device_.receive(bytes, now_, 115'200);
    return true;
  }
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override {
    if (fetched_ > 0) {
      std::copy_n(ready_.begin(), std::min(fetched_, into.size()), into.begin());
      return std::min(std::exchange(fetched_, 0), into.size());
    }
    for (;;) {
      device_.pass(now_);
      if (const std::size_t got = device_.take(into, now_); got > 0) return got;
      if (now_ >= until_ns) return 0;
      now_ = std::max(now_, std::min(until_ns, device_.due_ns()));
    }
  }
  void discard() noexcept override {}
  std::int64_t now_ns() const noexcept override { return now_; }
  void set(std::int64_t now) noexcept { now_ = now; }
  // The device has measured until now; its bytes come with the next receive().
  void fetch() {
    device_.pass(now_);
    fetched_ = device_.take(ready_, now_);
  }

 private:
  imu::EmulatedImu& device_;
  std::int64_t now_ = 1'000'000;
  std::array<std::uint8_t, 900> ready_{};
  std::size_t fetched_ = 0;
};

}  // namespace kadans::test
