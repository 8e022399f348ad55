#include "serial_imu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "kadans/signal/input_error.h"
#include "signal/number_text.h"

namespace kadans::imu {
namespace {

constexpr int tries = 3;
constexpr std::uint16_t gap_max = 1000;     // more numbers are not missing: the device began again
constexpr std::int64_t creep_per = 10'000;  // 100 ppm
constexpr std::uint16_t mode_calibrated = 0x0002;
constexpr std::uint32_t settings_counted_without_magnetometer = 0x0000'0041;

std::string hex(Octets bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += printed("%02X", unsigned{byte});
  return text;
}

std::array<std::uint8_t, 2> big_endian(std::uint16_t value) noexcept {
  return {static_cast<std::uint8_t>(value >> 8U), static_cast<std::uint8_t>(value)};
}

std::string_view words_of(std::uint8_t error) noexcept {
  switch (error) {
    case 0x03:
      return "a period that it does not have";
    case 0x04:
      return "a message that it does not know, or not now";
    case 0x21:
      return "a value that it does not have";
    default:
      return "an error of its own";
  }
}

}  // namespace

SerialImu::SerialImu(SerialImuSettings settings, std::unique_ptr<SerialPort> port)
    : settings_(std::move(settings)), port_(std::move(port)) {}

void SerialImu::fail(const std::string& why) const {
  throw InputError(settings_.place.with("the IMU on " + settings_.device + " " + why));
}

SerialImu::Answer SerialImu::ask(Message request, Octets data, ReceivedMessage& answer) noexcept {
  std::array<std::uint8_t, message_overhead + data_bytes_max> bytes;
  const std::size_t size = write_message(request, data, bytes);
  if (size == 0 || !port_->send(Octets(bytes).first(size))) return Answer::silence;
  const std::int64_t until_ns = port_->now_ns() + std::llround(1e9 * settings_.patience_s);
  for (;;) {
    while (scanner_.next(answer)) {
      if (answer.id == static_cast<std::uint8_t>(request) + 1) return Answer::good;
      if (answer.id == static_cast<std::uint8_t>(Message::error) && !answer.data.empty()) {
        error_ = answer.data[0];
        return Answer::refused;
      }
    }
    if (port_->now_ns() >= until_ns) return Answer::silence;  // one that measures may never let it be quiet
    scanner_.filled(port_->receive(scanner_.room(), until_ns));
  }
}

void SerialImu::insist(Message request, Octets data, ReceivedMessage& answer) {
  Answer is = Answer::silence;
  for (int i = 0; i < tries && is == Answer::silence; ++i) is = ask(request, data, answer);
  if (is == Answer::good) return;
  if (is == Answer::refused)
    fail("refuses " + std::string(words_of(error_)) + " (error " + hex({&error_, 1}) + ", message " +
         hex(std::array{static_cast<std::uint8_t>(request)}) + ")");
  const bool garbage = scanner_.counts().packets == 0 && scanner_.counts().skipped > 0;
  fail((garbage ? "answers garbage: is it no Xsens, or has it another baud rate than "
                : "does not answer: is it powered, and is its baud rate ") +
       std::to_string(settings_.baud) + "?");
}

void SerialImu::check_id(Octets id) const {
  const std::string is = hex(id.last(std::min<std::size_t>(4, id.size())));
  std::string meant = settings_.id;
  std::ranges::transform(meant, meant.begin(), [](char c) { return c >= 'a' && c <= 'f' ? c - 'a' + 'A' : c; });
  if (!meant.empty() && is != meant) fail("has the id " + is + ", the configuration says " + meant);
}

void SerialImu::set_up_items() {
  std::array<std::uint8_t, 12> wanted{};
  const auto put = [&](std::size_t at, std::uint16_t item, std::uint16_t rate_Hz) {
    std::ranges::copy(big_endian(item), wanted.begin() + static_cast<std::ptrdiff_t>(at));
    std::ranges::copy(big_endian(rate_Hz), wanted.begin() + static_cast<std::ptrdiff_t>(at) + 2);
  };
  const auto rate_Hz = static_cast<std::uint16_t>(settings_.rate_Hz);
  put(0, packet_counter, 0xFFFF);
  put(4, acceleration, rate_Hz);
  put(8, rate_of_turn, rate_Hz);
  ReceivedMessage answer;
  insist(Message::set_output_configuration, wanted, answer);
  for (std::size_t at = 4; at < wanted.size(); at += 4) {
    const auto given = [&](std::size_t k) {
      return k + 4 <= answer.data.size() && u16_at(answer.data, k) == u16_at(wanted, at);
    };
    std::size_t k = 0;
    while (k + 4 <= answer.data.size() && !given(k)) k += 4;
    const std::string what = at == 4 ? "accelerations" : "rates of turn";
    if (!given(k)) fail("gives no " + what);
    if (const std::uint16_t its_Hz = u16_at(answer.data, k + 2); its_Hz != rate_Hz)
      fail("gives " + what + " at " + std::to_string(its_Hz) + " Hz: plant.serial_imu.rate_Hz is " +
           std::to_string(rate_Hz));
  }
}

void SerialImu::set_up_mode() {
  ReceivedMessage answer;
  insist(Message::set_period, big_endian(static_cast<std::uint16_t>(mtdata_ticks_per_s / settings_.rate_Hz)), answer);
  insist(Message::set_output_skip_factor, big_endian(0), answer);
  insist(Message::set_output_mode, big_endian(mode_calibrated), answer);
  const std::uint32_t all = settings_counted_without_magnetometer;
  insist(Message::set_output_settings, std::array<std::uint8_t, 4>{0, 0, 0, static_cast<std::uint8_t>(all)}, answer);
}

bool SerialImu::open(bool (*give_up)() noexcept) {
  port_->discard();
  ReceivedMessage answer;
  insist(Message::go_to_config, {}, answer);
  insist(Message::req_device_id, {}, answer);
  check_id(answer.data);
  if (settings_.protocol == Protocol::mtdata2) {
    set_up_items();
  } else {
    set_up_mode();
  }
  insist(Message::go_to_measurement, {}, answer);
  const std::int64_t until_ns = port_->now_ns() + std::llround(1e9 * settings_.patience_s);
  news_ = {};
  while (news_.counts.readings == 0 && port_->now_ns() < until_ns) {
    if (give_up != nullptr && give_up()) return false;
    receive(until_ns);
  }
  if (news_.counts.readings == 0)
    fail(news_.counts.strange > 0 ? "sends readings that were not asked for: is plant.serial_imu.protocol right?"
                                  : "is set up, but sends no readings");
  return true;
}

void SerialImu::receive(std::int64_t until_ns) noexcept {
  const std::size_t got = port_->receive(scanner_.room(), until_ns);
  const std::int64_t arrived_ns = port_->now_ns();
  scanner_.filled(got);
  ReceivedMessage message;
  while (scanner_.next(message)) {
    Reading reading;
    switch (decode(settings_.protocol, message, reading)) {
      case Decoded::reading:
        take(reading, arrived_ns);
        break;
      case Decoded::strange:
        ++news_.counts.strange;
        break;
      case Decoded::other:
        break;
    }
  }
  news_.counts.corrupt = static_cast<std::uint32_t>(scanner_.counts().corrupt);
}

void SerialImu::take(const Reading& reading, std::int64_t arrived_ns) noexcept {
  const auto step = static_cast<std::uint16_t>(reading.counter - counter_);
  const std::int64_t period_ns = ns_per_s / settings_.rate_Hz;
  const bool first = news_.counts.readings == 0 || step > gap_max;
  if (!first && step == 0) return;  // it came again
  counter_ = reading.counter;
  if (!first) news_.counts.lost += step - 1U;
  number_ = first ? 0 : number_ + step;
  const std::int64_t zero_ns = arrived_ns - number_ * period_ns;
  zero_ns_ = first ? zero_ns : std::min(zero_ns, zero_ns_ + step * period_ns / creep_per);
  const std::int64_t behind_ns =
      wire_ns(reading_bytes(settings_.protocol), settings_.baud) + std::llround(1e9 * settings_.delay_s);
  ImuSample& sample = news_.sample;
  sample.angular_velocity_rad_s = reading.angular_velocity_rad_s;
  sample.acceleration_m_s2 = reading.acceleration_m_s2;
  ++sample.sequence;
  sample.time_ns = zero_ns_ + number_ * period_ns - behind_ns;
  ++news_.counts.readings;
}

}  // namespace kadans::imu
