// An IMU on a serial line: found, set up, and read.
//
// When a reading was measured is told by its number, not by when it arrived: an adapter keeps bytes back now more, now
// less. The time of number 0 is taken from the message that came soonest of all, and creeps on by 100 ppm, so that it
// follows a device whose clock is slow. From there a reading's time is its number times the period, less the time of
// its bytes on the wire and delay_s.
//
// One owner, one thread at a time. receive() neither allocates nor throws.
#pragma once

#include <memory>

#include "kadans/signal/frames.h"
#include "message.h"
#include "plant/serial/serial_port.h"
#include "settings.h"

namespace kadans::imu {

struct ImuCounts {
  std::uint32_t readings = 0;
  std::uint32_t lost = 0;     // numbers that never came
  std::uint32_t corrupt = 0;  // messages with a wrong checksum or length
  std::uint32_t strange = 0;  // readings that were not asked for, or that no device measures: not used
};

struct ImuNews {
  ImuSample sample;  // in the device's frame
  ImuCounts counts;
};

class SerialImu {
 public:
  SerialImu(SerialImuSettings settings, std::unique_ptr<SerialPort> port);

  // Finds the device, sets it up, and waits for its first reading. False: give_up() said so. Throws InputError that
  // says what is there instead.
  bool open(bool (*give_up)() noexcept);
  void receive(std::int64_t until_ns) noexcept;  // takes what comes until then, at least what is there
  const ImuNews& news() const noexcept { return news_; }
  std::int64_t now_ns() const noexcept { return port_->now_ns(); }

 private:
  enum class Answer : std::uint8_t { good, silence, refused };
  [[noreturn]] void fail(const std::string& why) const;
  Answer ask(Message request, Octets data, ReceivedMessage& answer) noexcept;
  void insist(Message request, Octets data, ReceivedMessage& answer);
  void check_id(Octets id) const;
  void set_up_items();
  void set_up_mode();
  void take(const Reading& reading, std::int64_t arrived_ns) noexcept;

  SerialImuSettings settings_;
  std::unique_ptr<SerialPort> port_;
  MessageScanner scanner_;
  ImuNews news_;
  std::uint8_t error_ = 0;
  std::uint16_t counter_ = 0;
  std::int64_t number_ = 0;  // of the newest reading, since the first
  std::int64_t zero_ns_ = 0;
};

}  // namespace kadans::imu
