// A serial port, and the clock that its bytes go by: of the system, or one on virtual time.
//
// One owner, one thread at a time. send and receive neither allocate nor throw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kadans/plant/plant_type.h"
#include "signal/monotonic_clock.h"
#include "signal/owned_descriptor.h"

namespace kadans {

class SerialPort {
 public:
  virtual ~SerialPort() = default;
  SerialPort() = default;
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  // False: the system did not take all of it.
  virtual bool send(std::span<const std::uint8_t> bytes) noexcept = 0;
  // Waits until bytes are here, at most until this time; returns how many it put into `into`.
  virtual std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept = 0;
  virtual void discard() noexcept = 0;  // what came unasked
  virtual std::int64_t now_ns() const noexcept = 0;
};

// Of the system: raw, 8 bits, no parity, one stop bit. The clock is CLOCK_MONOTONIC.
class TerminalPort final : public SerialPort {
 public:
  // Throws InputError that says what is wrong with the device: not there, no right to open it, somebody else's, no
  // serial port, a baud rate that it cannot have.
  TerminalPort(const std::string& device, std::uint32_t baud);

  bool send(std::span<const std::uint8_t> bytes) noexcept override;
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override;
  void discard() noexcept override;
  std::int64_t now_ns() const noexcept override { return monotonic_ns(); }
  void set_baud(std::uint32_t baud);  // throws InputError

 private:
  std::string device_;
  OwnedDescriptor descriptor_;
};

// The port of this device. Throws InputError at `place`, where the device is named.
std::unique_ptr<SerialPort> open_port(const std::string& device, std::uint32_t baud, const InputProblem& place);

// The time that bytes take on the wire: 10 bits each.
constexpr std::int64_t wire_ns(std::size_t bytes, std::uint32_t baud) noexcept {
  return static_cast<std::int64_t>(bytes) * 10'000'000'000 / static_cast<std::int64_t>(baud);
}

// For `kadans doctor ROBOT`, which opens nothing: adds what helps or hinders a device on a serial port of this machine.
// That is the port with this user's right to it ("port NAME"), and the USB adapter's latency timer ("latency NAME").
void examine_serial_port(const std::string& name, const std::string& device, std::vector<PlantType::Finding>& findings);

}  // namespace kadans
