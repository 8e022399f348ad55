// An Xsens MT device on the other side of a serial line, in time that the caller passes: it answers what it is asked,
// and measures at its rate while it is told to. It is written from the protocol's document and shares no code with the
// driver.
//
// One owner, one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kadans/signal/frames.h"
#include "plant/imu/settings.h"
#include "plant/serial/emulated_line.h"

namespace kadans::imu {

// Faults befall the bytes that it sends.
class EmulatedImu : public EmulatedLine {
 public:
  struct Settings {
    bool old = false;  // an MTi or MTx before the MTi 10
    std::uint32_t id = 0x037003F8;
    std::int64_t delay_ns = 2'000'000;  // from the measurement until its message begins
    std::uint32_t rate_max_Hz = 400;
  };

  EmulatedImu(const Settings& settings, std::uint64_t seed) : EmulatedLine(seed, "imu"), settings_(settings) {}

  bool silent = false;  // its cable is out

  // What it would measure now, in its own frame.
  void feels(const Vec3& angular_velocity_rad_s, const Vec3& acceleration_m_s2) noexcept;
  void receive(std::span<const std::uint8_t> bytes, std::int64_t now_ns, std::uint32_t baud);
  // Time has come here: what is due is measured.
  void pass(std::int64_t now_ns);
  // When pass() or take() has something to do; INT64_MAX: nothing.
  std::int64_t due_ns() const noexcept;
  bool measures() const noexcept { return measures_; }
  std::uint64_t understood() const noexcept { return understood_; }

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Item {
    unsigned name, rate_Hz;
  };
  void carry_out(unsigned message, const Bytes& data, std::int64_t now_ns);
  void set_items(const Bytes& data, std::int64_t now_ns);
  void say(unsigned message, const Bytes& data, std::int64_t begin_ns);
  void measure(std::int64_t now_ns);

  Settings settings_;
  Bytes heard_;
  std::int64_t free_ns_ = INT64_MIN / 2, next_ns_ = 0;
  std::uint32_t baud_ = 115'200;
  bool measures_ = true;  // as it comes from its box
  std::vector<Item> items_{{0x1020, 100}, {0x2010, 100}};
  unsigned period_ = 1152, mode_ = 4;  // of an old one: of 115200 a second; orientation
  std::uint32_t output_ = 0;
  std::uint16_t counter_ = 0;
  Vec3 gyro_rad_s_{}, acceleration_m_s2_{0, 0, 9.81};
  std::uint64_t understood_ = 0;
};

// The device that a robot's configuration names.
EmulatedImu::Settings device_of(const SerialImuSettings& settings);

// Faults "of imu": bytes_lost, bytes_corrupt, cable_out. Throws std::invalid_argument that says what is wrong.
void check_imu_fault(const EmulatedFault& fault);
// Lets those of this time befall it.
void befall(EmulatedImu& device, const std::vector<EmulatedFault>& faults, double time_s) noexcept;

}  // namespace kadans::imu
