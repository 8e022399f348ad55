// The cycle of one port: writes what its servos are asked for, and reads what they measure, in one exchange.
//
// A cycle is one Sync Write and one Fast Sync Read (a Sync Read where a servo's firmware is too old), sent together.
// When it needs more, that follows once a cycle: operating modes that change, servos that reboot or come back. A servo
// that does not answer is found by asking one after the other, and is left out until a reset.
//
// One owner, the thread of the port, or the thread that steps virtual time. run() neither allocates nor throws; it
// waits for the servos, for a bounded time.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "kadans/signal/capacity.h"
#include "servo.h"

namespace kadans::dynamixel {

struct PortCounts {
  std::uint32_t cycles = 0;
  std::uint32_t answers = 0;  // readings of servos
  std::uint32_t lost = 0;     // readings that never came
  std::uint32_t corrupt = 0;  // packets with a wrong CRC or length, or from nobody who was asked
  std::uint32_t strange = 0;  // readings that no servo with its settings gives
  std::uint32_t late = 0;     // cycles that took longer than their period
  std::uint32_t limited = 0;  // goals beyond the servos' own limits, cut to these
};

// What a port tells the control thread: the newest reading of each of its servos.
struct PortSample {
  std::uint32_t count = 0;
  std::array<ServoReading, max_joints> servos{};
  PortCounts counts;
  double cycle_ms = 0;  // what the last exchange of goals and readings took
};
inline void copy_used(const PortSample& from, PortSample& to) noexcept {
  to.count = from.count;
  copy_first(from.servos, from.count, to.servos);
  to.counts = from.counts;
  to.cycle_ms = from.cycle_ms;
}

class PortCycle {
 public:
  struct Timing {
    std::uint32_t baud = 1'000'000;
    std::int64_t period_ns = 1'000'000;
    std::int64_t usb_latency_ns = 1'000'000;
    std::int64_t patience_ns = 20'000'000;  // while servos are found and set up
    double watchdog_s = 0.1;
  };

  // Keeps a reference to the port. The servos are those of this port, with the joint of each.
  PortCycle(SerialPort& port, const Timing& timing, std::vector<Servo> servos);

  // Before the first cycle: asks each servo what it is and sets it up. Throws InputError that says what is in the way;
  // `where` names the port in it. False: give_up() said so.
  bool open(const std::string& where, bool (*give_up)() noexcept);
  // Afterwards: takes the torque of all servos.
  void close() noexcept;

  // One cycle. The actuation is the drives', each at its joint's number.
  void run(const ActuationFrame& drives) noexcept;
  const PortSample& sample() const noexcept { return sample_; }
  const std::vector<Servo>& servos() const noexcept { return servos_; }

 private:
  void check_servo(const Servo& servo, const std::string& where);
  [[noreturn]] void fail(const Servo& servo, const std::string& where, const std::string& why) const;
  std::string others_that_answer(const Servo& but);
  void list_working() noexcept;
  void put(Octets packet) noexcept;
  void put_goals() noexcept;
  void put_read(std::uint16_t address, std::size_t bytes) noexcept;
  template <typename Take>
  void receive(std::size_t bytes, Take take) noexcept;
  void change_modes() noexcept;
  void serve_one() noexcept;
  void rearm_watchdogs() noexcept;
  void tell() noexcept;

  SerialPort& port_;
  Timing timing_;
  std::vector<Servo> servos_;
  ServoBus bus_;
  bool fast_ = true;
  std::array<std::uint8_t, max_joints> ids_{};   // of servos that are read and written
  std::array<std::size_t, max_joints> which_{};  // their indices
  std::size_t working_ = 0;
  std::array<std::uint8_t, 2 * packet_bytes_max> out_;
  std::size_t out_size_ = 0;
  PacketScanner scanner_;
  std::int64_t sent_ns_ = 0;
  std::size_t next_served_ = 0;
  PortCounts counts_;
  PortSample sample_;
};

}  // namespace kadans::dynamixel
