#include "message.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kadans::imu {
namespace {

constexpr std::uint8_t preamble = 0xFA, alone = 0xFF;  // "alone": of a device that is no part of a chain
constexpr std::size_t head_bytes = 4;

std::uint8_t sum_of(Octets bytes) noexcept {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint8_t>(sum);
}

// False: a value that no device measures.
bool take(Octets bytes, std::size_t at, double most, Vec3& into) noexcept {
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    into[i] = std::bit_cast<float>(u32_at(bytes, at + 4 * i));
    good = good && std::abs(into[i]) <= most;  // NaN fails
  }
  return good;
}

bool take_items(Octets data, Reading& reading) noexcept {
  bool counted = false, accelerated = false, turned = false;
  for (std::size_t at = 0; at < data.size();) {
    if (data.size() - at < 3) return false;
    const std::uint16_t item = u16_at(data, at);
    const std::size_t size = data[at + 2];
    at += 3;
    if (data.size() - at < size) return false;
    if (item == packet_counter && size == 2 && !counted) {
      counted = true;
      reading.counter = u16_at(data, at);
    } else if (item == acceleration && size == 12 && !accelerated) {
      accelerated = take(data, at, acceleration_max_m_s2, reading.acceleration_m_s2);
    } else if (item == rate_of_turn && size == 12 && !turned) {
      turned = take(data, at, gyro_max_rad_s, reading.angular_velocity_rad_s);
    } else {
      return false;
    }
    at += size;
  }
  return counted && accelerated && turned;
}

}  // namespace

std::size_t write_message(Message id, Octets data, std::span<std::uint8_t> into) noexcept {
  const std::size_t size = message_overhead + data.size();
  if (data.size() > data_bytes_max || size > into.size()) return 0;
  into[0] = preamble;
  into[1] = alone;
  into[2] = static_cast<std::uint8_t>(id);
  into[3] = static_cast<std::uint8_t>(data.size());
  std::ranges::copy(data, into.begin() + head_bytes);
  into[size - 1] = static_cast<std::uint8_t>(-sum_of(into.subspan(1, size - 2)));
  return size;
}

bool MessageScanner::next(ReceivedMessage& message) noexcept {
  for (;;) {
    const Octets bytes = here();
    const bool begins = !bytes.empty() && bytes[0] == preamble && (bytes.size() < 2 || bytes[1] == alone);
    if (bytes.empty()) return false;
    if (!begins) {
      skip(1);
      continue;
    }
    if (bytes.size() < head_bytes) return false;
    const std::size_t size = message_overhead + bytes[3];
    const bool fits = bytes[3] <= data_bytes_max;
    if (fits && bytes.size() < size) return false;
    if (!fits || sum_of(bytes.subspan(1, size - 1)) != 0) {
      ++counts_.corrupt;
      skip(1);
      continue;
    }
    ++counts_.packets;
    drop(size);
    message = {.id = bytes[2], .data = bytes.subspan(head_bytes, bytes[3])};
    return true;
  }
}

Decoded decode(Protocol protocol, const ReceivedMessage& message, Reading& reading) noexcept {
  const bool items = message.id == static_cast<std::uint8_t>(Message::mtdata2);
  if (!items && message.id != static_cast<std::uint8_t>(Message::mtdata)) return Decoded::other;
  if (items != (protocol == Protocol::mtdata2)) return Decoded::strange;
  if (items) return take_items(message.data, reading) ? Decoded::reading : Decoded::strange;
  const bool good = message.data.size() == mtdata_bytes &&
                    take(message.data, 0, acceleration_max_m_s2, reading.acceleration_m_s2) &&
                    take(message.data, 12, gyro_max_rad_s, reading.angular_velocity_rad_s);
  if (good) reading.counter = u16_at(message.data, 24);
  return good ? Decoded::reading : Decoded::strange;
}

}  // namespace kadans::imu
