// Where the datagrams of one board go out and come in.
//
// One owner, one thread at a time. Nothing allocates or throws after the construction.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "settings.h"
#include "signal/monotonic_clock.h"
#include "signal/owned_descriptor.h"

namespace kadans::hostmot2 {

using Octets = std::span<const std::uint8_t>;

class DatagramPort {
 public:
  virtual ~DatagramPort() = default;
  DatagramPort() = default;
  DatagramPort(const DatagramPort&) = delete;
  DatagramPort& operator=(const DatagramPort&) = delete;

  virtual bool send(Octets datagram) noexcept = 0;
  // Takes one datagram; looks for it until this time, at least once. 0: none came. One that is longer than `into` is
  // cut, and counts as longer.
  virtual std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept = 0;
  // Before the loop: sleeps until one has come, at most until then.
  virtual void await(std::int64_t until_ns) noexcept = 0;
  virtual std::int64_t now_ns() const noexcept = 0;
  // Before the loop: what on this machine is in the way of answers; "": nothing that it knows.
  virtual std::string why_silent() const { return ""; }
};

// Of the system, on CLOCK_MONOTONIC.
class UdpPort final : public DatagramPort {
 public:
  explicit UdpPort(BoardSettings board);  // throws InputError at the board's place
  bool send(Octets datagram) noexcept override;
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override;
  void await(std::int64_t until_ns) noexcept override;
  std::int64_t now_ns() const noexcept override { return monotonic_ns(); }
  std::string why_silent() const override;

 private:
  BoardSettings board_;
  OwnedDescriptor descriptor_;
};

}  // namespace kadans::hostmot2
