#include "emulated_imu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include "plant/imu/message.h"

namespace kadans::imu {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint64_t value, unsigned size) {
  while (size-- > 0) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * size)));
}

// A knock harder than what the device measures is told as the most that it does.
Vec3 within(Vec3 values, double most) noexcept {
  for (double& value : values) value = std::clamp(value, -most, most);
  return values;
}

void put(std::vector<std::uint8_t>& bytes, const Vec3& values) {
  for (const double value : values) put(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
}

unsigned number(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t size) {
  unsigned value = 0;
  for (std::size_t i = at; i < at + size && i < bytes.size(); ++i) value = 256 * value + bytes[i];
  return value;
}

}  // namespace

void EmulatedImu::feels(const Vec3& angular_velocity_rad_s, const Vec3& acceleration_m_s2) noexcept {
  gyro_rad_s_ = within(angular_velocity_rad_s, gyro_max_rad_s);
  acceleration_m_s2_ = within(acceleration_m_s2, acceleration_max_m_s2);
}

void EmulatedImu::receive(std::span<const std::uint8_t> bytes, std::int64_t now_ns, std::uint32_t baud) {
  if (silent) return;
  if (baud != 0) baud_ = baud;
  heard_.insert(heard_.end(), bytes.begin(), bytes.end());
  for (;;) {
    const auto head = std::ranges::find(heard_, std::uint8_t{0xFA});
    heard_.erase(heard_.begin(), head);
    if (heard_.size() < 5) return;
    const std::size_t size = 5U + heard_[3];
    if (heard_[1] == 0xFF && heard_[3] != 0xFF && heard_.size() < size) return;
    unsigned sum = 0;
    for (std::size_t i = 1; i < size && i < heard_.size(); ++i) sum += heard_[i];
    if (heard_[1] != 0xFF || heard_[3] == 0xFF || sum % 256 != 0) {
      heard_.erase(heard_.begin());
      continue;
    }
    const unsigned message = heard_[2];
    const Bytes data(heard_.begin() + 4, heard_.begin() + static_cast<std::ptrdiff_t>(size) - 1);
    heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(size));
    ++understood_;
    carry_out(message, data, now_ns);
  }
}

void EmulatedImu::carry_out(unsigned message, const Bytes& data, std::int64_t now_ns) {
  const auto done = [&] { say(message + 1, {}, now_ns); };
  const auto refuse = [&](std::uint8_t why) { say(0x42, {why}, now_ns); };
  if (message == 0x30) {
    measures_ = false;
    return done();
  }
  if (measures_) return;  // it listens to nothing else
  Bytes id;
  switch (message) {
    case 0x00:
      put(id, settings_.id, 4);
      return say(0x01, id, now_ns);
    case 0x10:
      measures_ = true;
      counter_ = 0;
      next_ns_ = now_ns;
      return done();
    case 0xC0:
      return settings_.old ? refuse(0x04) : set_items(data, now_ns);
    case 0x04:
    case 0xD0:
    case 0xD2:
    case 0xD4:
      if (!settings_.old) return refuse(0x04);
      if (message == 0x04 && (number(data, 0, 2) < 115'200 / settings_.rate_max_Hz)) return refuse(0x03);
      if (message == 0x04) period_ = number(data, 0, 2);
      if (message == 0xD0) mode_ = number(data, 0, 2);
      if (message == 0xD2) output_ = number(data, 0, 4);
      return done();
    default:
      return refuse(0x04);
  }
}

// Rates that it does not have become the nearest below; items that it does not have are left out.
void EmulatedImu::set_items(const Bytes& data, std::int64_t now_ns) {
  items_.clear();
  Bytes said;
  for (std::size_t at = 0; at + 4 <= data.size(); at += 4) {
    Item item{.name = number(data, at, 2), .rate_Hz = number(data, at + 2, 2)};
    if (item.name != 0x1020 && item.name != 0x4020 && item.name != 0x8020) continue;
    if (item.name != 0x1020) item.rate_Hz = std::min(item.rate_Hz, settings_.rate_max_Hz);
    items_.push_back(item);
    put(said, item.name, 2);
    put(said, item.rate_Hz, 2);
  }
  say(0xC1, said, now_ns);
}

void EmulatedImu::say(unsigned message, const Bytes& data, std::int64_t begin_ns) {
  Bytes bytes{0xFA, 0xFF, static_cast<std::uint8_t>(message), static_cast<std::uint8_t>(data.size())};
  bytes.insert(bytes.end(), data.begin(), data.end());
  unsigned sum = 0;
  for (std::size_t i = 1; i < bytes.size(); ++i) sum += bytes[i];
  bytes.push_back(static_cast<std::uint8_t>(256 - sum % 256));
  free_ns_ = std::max(free_ns_, begin_ns) + std::llround(1e10 / baud_ * static_cast<double>(bytes.size()));
  if (!silent) send(bytes, free_ns_);
}

void EmulatedImu::measure(std::int64_t now_ns) {
  Bytes data;
  if (settings_.old) {
    if ((mode_ & 2U) != 0) {
      if ((output_ & 0x10U) == 0) put(data, acceleration_m_s2_);
      if ((output_ & 0x20U) == 0) put(data, gyro_rad_s_);
      if ((output_ & 0x40U) == 0) put(data, Vec3{0.2, 0, 0.4});
    }
    if ((mode_ & 4U) != 0) put(data, Vec3{1, 0, 0}), put(data, 0, 4);
    if ((output_ & 1U) != 0) put(data, counter_, 2);
  } else {
    for (const Item& item : items_) {
      put(data, item.name, 2);
      if (item.name == 0x1020) put(data, 2, 1), put(data, counter_, 2);
      if (item.name == 0x4020) put(data, 12, 1), put(data, acceleration_m_s2_);
      if (item.name == 0x8020) put(data, 12, 1), put(data, gyro_rad_s_);
      if (item.name == 0x2010) put(data, 16, 1), put(data, Vec3{1, 0, 0}), put(data, 0, 4);
    }
  }
  ++counter_;
  say(settings_.old ? 0x32 : 0x36, data, now_ns + settings_.delay_ns);
}

void EmulatedImu::pass(std::int64_t now_ns) {
  if (!measures_) return;
  unsigned rate_Hz = 0;
  for (const Item& item : items_) rate_Hz = item.rate_Hz == 0xFFFF ? rate_Hz : std::max(rate_Hz, item.rate_Hz);
  const double period_ns = settings_.old ? 1e9 * period_ / 115'200 : 1e9 / std::max(1U, rate_Hz);
  if (next_ns_ < now_ns - 1'000'000'000) next_ns_ = now_ns;  // nobody asked it for long
  for (; next_ns_ <= now_ns; next_ns_ += std::llround(period_ns)) measure(next_ns_);
}

std::int64_t EmulatedImu::due_ns() const noexcept {
  return measures_ ? std::min(next_byte_ns(), next_ns_) : next_byte_ns();
}

EmulatedImu::Settings device_of(const SerialImuSettings& settings) {
  EmulatedImu::Settings is{.old = settings.protocol == Protocol::mtdata,
                           .delay_ns = std::llround(1e9 * settings.delay_s),
                           .rate_max_Hz = std::max(settings.rate_Hz, 100U)};
  if (!settings.id.empty()) is.id = static_cast<std::uint32_t>(std::stoul(settings.id, nullptr, 16));
  return is;
}

void check_imu_fault(const EmulatedFault& fault) {
  const bool share = fault.kind == "bytes_lost" || fault.kind == "bytes_corrupt";
  if (!share && fault.kind != "cable_out")
    throw std::invalid_argument("no fault '" + fault.kind +
                                "' of the IMU; there are bytes_lost, bytes_corrupt, cable_out");
  if (share && !(fault.size > 0 && fault.size <= 1)) throw std::invalid_argument(fault.kind + ": a share is 0..1");
}

void befall(EmulatedImu& device, const std::vector<EmulatedFault>& faults, double time_s) noexcept {
  if (faults.empty()) return;
  device.faults = {};
  device.silent = false;
  for (const EmulatedFault& fault : faults) {
    if (!(time_s >= fault.from_s && time_s < fault.until_s)) continue;
    if (fault.kind == "bytes_lost") device.faults.lost = fault.size;
    if (fault.kind == "bytes_corrupt") device.faults.corrupt = fault.size;
    if (fault.kind == "cable_out") device.silent = true;
  }
}

}  // namespace kadans::imu
