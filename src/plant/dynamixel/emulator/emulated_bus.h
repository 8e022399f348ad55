// A half-duplex line with servos at one end and a USB adapter at the other, in time that the caller passes: bytes take
// ten bits each, servos wait for their return delays, the adapter keeps bytes back for its latency. What the servos
// answer to bytes does not depend on how the bytes came in pieces.
//
// One owner, one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emulated_servo.h"
#include "plant/serial/emulated_line.h"

namespace kadans::dynamixel {

// Faults befall bytes in both directions.
class EmulatedBus : public EmulatedLine {
 public:
  EmulatedBus(std::int64_t usb_latency_ns, std::uint64_t seed)
      : EmulatedLine(seed, "bus"), usb_latency_ns_(usb_latency_ns) {}

  std::vector<EmulatedServo> servos;

  // The host begins to send these bytes now, at this baud rate.
  void receive(std::span<const std::uint8_t> bytes, std::int64_t now_ns, std::uint32_t baud);
  // When take() has the next byte; INT64_MAX: none is on the way.
  std::int64_t due_ns() const noexcept { return next_byte_ns(); }
  void set_usb_latency(std::int64_t latency_ns) noexcept { usb_latency_ns_ = latency_ns; }
  std::uint64_t instructions() const noexcept { return instructions_; }
  std::uint64_t sync_reads() const noexcept { return sync_reads_; }  // fast ones, too
  std::uint64_t not_understood() const noexcept { return not_understood_; }

 private:
  using Message = std::vector<std::uint8_t>;

  bool parse();
  void carry_out(std::uint8_t id, const Message& body, bool crc_good);
  // Each returns the answer, empty where there is none.
  Message one(EmulatedServo& servo, bool broadcast, const Message& body);
  Message status(const EmulatedServo& servo, std::uint8_t error, const Message& data) const;
  void sync_read(const Message& body, bool fast);
  void sync_write(const Message& body);
  void answer(const Message& bytes, double delay_s);
  EmulatedServo* find(std::uint8_t id);

  std::int64_t usb_latency_ns_;
  Message heard_;
  std::uint32_t baud_ = 0;
  std::int64_t free_ns_ = INT64_MIN / 2;   // when the wire is free again
  std::int64_t asked_ns_ = INT64_MIN / 2;  // when the instruction that is answered was over
  std::uint64_t instructions_ = 0, sync_reads_ = 0, not_understood_ = 0;
};

}  // namespace kadans::dynamixel
