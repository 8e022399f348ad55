#include "emulated_bus.h"

#include <algorithm>
#include <cmath>

namespace kadans::dynamixel {
namespace {

// Bit by bit, as the manual defines it.
unsigned checksum(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) {
    sum ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) sum = ((sum << 1U) ^ ((sum & 0x8000U) != 0 ? 0x8005U : 0U)) & 0xFFFFU;
  }
  return sum;
}

void append_sum(std::vector<std::uint8_t>& bytes) {
  const unsigned sum = checksum(bytes);
  bytes.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(sum >> 8U));
}

bool header_at(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && bytes[0] == 0xFF && bytes[1] == 0xFF && bytes[2] == 0xFD && bytes[3] == 0x00;
}

unsigned word(const std::vector<std::uint8_t>& body, std::size_t at) {
  return at + 1 < body.size() ? body[at] + 256U * body[at + 1] : 0U;
}

}  // namespace

void EmulatedBus::receive(std::span<const std::uint8_t> bytes, std::int64_t now_ns, std::uint32_t baud) {
  if (baud == 0) return;
  baud_ = baud;
  const double byte_ns = 1e10 / baud;
  free_ns_ = std::max(free_ns_, now_ns);
  const std::int64_t begin_ns = free_ns_;
  std::size_t sent = 0;
  for (std::uint8_t byte : bytes) {
    ++sent;
    const std::int64_t end_ns = begin_ns + std::llround(byte_ns * static_cast<double>(sent));
    free_ns_ = std::max(free_ns_, end_ns);
    if (disturbed(byte)) continue;
    heard_.push_back(byte);
    asked_ns_ = end_ns;
    while (parse()) {
    }
  }
}

// True when something was taken from what was heard, and there may be more.
bool EmulatedBus::parse() {
  const auto drop = [&](std::size_t count) {
    heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(count));
    return true;
  };
  if (heard_.size() < 7) return false;
  if (!header_at(heard_)) return drop(1);
  const std::size_t length = word(heard_, 5), size = 7 + length;
  if (length < 3 || size > 1024) {
    ++not_understood_;
    return drop(4);
  }
  if (heard_.size() < size) return false;
  Message body;
  for (std::size_t i = 7; i + 2 < size; ++i) {
    body.push_back(heard_[i]);
    const std::size_t n = body.size();
    const bool header = n >= 3 && body[n - 3] == 0xFF && body[n - 2] == 0xFF && body[n - 1] == 0xFD;
    if (header && i + 3 < size && heard_[i + 1] == 0xFD) ++i;
  }
  const bool good = checksum(std::span(heard_).first(size - 2)) == word(heard_, size - 2);
  const std::uint8_t to = heard_[4];
  drop(size);
  if (!good) ++not_understood_;
  carry_out(to, body, good);
  return true;
}

EmulatedServo* EmulatedBus::find(std::uint8_t id) {
  const auto found = std::ranges::find_if(
      servos, [&](const EmulatedServo& servo) { return servo.id() == id && servo.hears() && servo.baud() == baud_; });
  return found == servos.end() ? nullptr : &*found;
}

void EmulatedBus::carry_out(std::uint8_t id, const Message& body, bool crc_good) {
  if (body.empty() || body[0] == 0x55) return;
  ++instructions_;
  if (crc_good) {
    for (EmulatedServo& servo : servos) {
      if (servo.hears() && servo.baud() == baud_) servo.heard();
    }
  }
  if (!crc_good) {
    if (EmulatedServo* const servo = find(id)) answer(status(*servo, EmulatedServo::crc, {}), servo->return_delay_s());
    return;
  }
  if (body[0] == 0x82 || body[0] == 0x8A) return sync_read(body, body[0] == 0x8A);
  if (body[0] == 0x83) return sync_write(body);
  Message at_once;
  double delay_s = 0;
  for (EmulatedServo& servo : servos) {
    if (!servo.hears() || servo.baud() != baud_ || (id != 0xFE && servo.id() != id)) continue;
    const double its_delay_s = servo.return_delay_s();
    const Message said = one(servo, id == 0xFE, body);
    if (id == 0xFE) {
      if (!said.empty()) answer(said, its_delay_s);
      continue;
    }
    // Servos of the same id answer at the same time: the wire is high where both let it be.
    for (std::size_t i = 0; i < said.size(); ++i) {
      if (i < at_once.size()) at_once[i] &= said[i];
      if (i >= at_once.size()) at_once.push_back(said[i]);
    }
    delay_s = its_delay_s;
  }
  if (!at_once.empty()) answer(at_once, delay_s);
}

EmulatedBus::Message EmulatedBus::one(EmulatedServo& servo, bool broadcast, const Message& body) {
  const std::uint8_t level = servo.return_level();
  const auto unless_broadcast = [&](std::uint8_t error, const Message& data = {}) {
    return broadcast ? Message() : status(servo, error, data);
  };
  switch (body[0]) {
    case 0x01: {
      const std::uint16_t number = servo.model();
      return status(servo, 0,
                    {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8U), servo.firmware()});
    }
    case 0x02: {
      if (level < 1) return {};
      Message data;
      const std::uint8_t error =
          body.size() == 5 ? servo.read(word(body, 1), word(body, 3), data) : EmulatedServo::length;
      return unless_broadcast(error, data);
    }
    case 0x03: {
      // It answers as what it was when it was asked.
      Message said = unless_broadcast(0);
      const std::uint8_t error =
          body.size() < 4 ? EmulatedServo::length : servo.write(word(body, 1), std::span(body).subspan(3));
      if (level < 2) return {};
      return error == 0 ? said : unless_broadcast(error);
    }
    case 0x06: {
      const std::uint8_t what = body.size() > 1 ? body[1] : 0;
      if (broadcast && what == 0xFF) return {};
      Message said = unless_broadcast(0);
      servo.factory_reset(what == 1 || what == 2, what == 2);
      return said;
    }
    case 0x08: {
      Message said = unless_broadcast(0);
      servo.reboot();
      return said;
    }
    case 0x10:
      return unless_broadcast(0);
    default:
      return unless_broadcast(EmulatedServo::instruction);
  }
}

void EmulatedBus::sync_read(const Message& body, bool fast) {
  ++sync_reads_;
  if (body.size() < 6) return;
  const unsigned address = word(body, 1), count = word(body, 3);
  const std::size_t asked = body.size() - 5;
  Message packet{0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0, 0, 0x55};
  packet[5] = static_cast<std::uint8_t>(1 + asked * (count + 4));
  packet[6] = static_cast<std::uint8_t>((1 + asked * (count + 4)) >> 8U);
  double delay_s = 0;
  for (std::size_t i = 5; i < body.size(); ++i) {
    EmulatedServo* const servo = find(body[i]);
    if (servo == nullptr || (fast && servo->firmware() < 45)) break;  // those behind wait for it in vain
    Message data;
    const std::uint8_t error = servo->read(address, count, data);
    data.resize(count);
    if (fast) {
      if (i == 5) delay_s = servo->return_delay_s();
      packet.push_back(static_cast<std::uint8_t>(error | servo->alert()));
      packet.push_back(servo->id());
      packet.insert(packet.end(), data.begin(), data.end());
      append_sum(packet);
    } else {
      answer(status(*servo, error, data), servo->return_delay_s());
    }
  }
  if (fast && packet.size() > 8) answer(packet, delay_s);
}

void EmulatedBus::sync_write(const Message& body) {
  if (body.size() < 5) return;
  const unsigned address = word(body, 1), count = word(body, 3);
  for (std::size_t at = 5; at + count < body.size(); at += count + 1) {
    for (EmulatedServo& servo : servos) {
      if (servo.id() == body[at] && servo.hears() && servo.baud() == baud_)
        (void)servo.write(address, std::span(body).subspan(at + 1, count));
    }
  }
}

EmulatedBus::Message EmulatedBus::status(const EmulatedServo& servo, std::uint8_t error, const Message& data) const {
  Message packet{0xFF, 0xFF, 0xFD, 0x00, servo.id(), 0, 0, 0x55, static_cast<std::uint8_t>(error | servo.alert())};
  for (const std::uint8_t byte : data) {
    packet.push_back(byte);
    const std::size_t n = packet.size();
    if (n >= 10 && packet[n - 3] == 0xFF && packet[n - 2] == 0xFF && byte == 0xFD) packet.push_back(0xFD);
  }
  const std::size_t length = packet.size() + 2 - 7;
  packet[5] = static_cast<std::uint8_t>(length);
  packet[6] = static_cast<std::uint8_t>(length >> 8U);
  append_sum(packet);
  return packet;
}

void EmulatedBus::answer(const Message& bytes, double delay_s) {
  const std::int64_t begin_ns = std::max(free_ns_, asked_ns_) + std::llround(1e9 * delay_s);
  const std::int64_t end_ns = begin_ns + std::llround(1e10 / baud_ * static_cast<double>(bytes.size()));
  send(bytes, end_ns + usb_latency_ns_);
  free_ns_ = end_ns;
}

}  // namespace kadans::dynamixel
