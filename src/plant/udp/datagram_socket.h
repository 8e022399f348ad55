// A socket for datagrams, and a batch of those that it received. Receiving and sending never block, allocate or throw:
// they are the only system calls in the tick.
//
// One owner, one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "plant/socket_address.h"
#include "signal/owned_descriptor.h"
#include "wire.h"

namespace kadans {

class DatagramSocket {
 public:
  static constexpr std::size_t batch_max = 16;

  explicit DatagramSocket(int descriptor) : descriptor_(descriptor) {}  // takes it over

  // Sleeps until a datagram has come, at most this long. Before the loop only.
  void wait(int milliseconds) const noexcept;
  // Takes the datagrams that have come, at most batch_max; returns how many. They stay until the next call.
  std::size_t receive() noexcept;
  Bytes datagram(std::size_t index) const noexcept;  // empty when it was longer than wire_bytes_max
  const PeerAddress& from(std::size_t index) const noexcept;
  // False when the system does not accept it. Without an address, or with one that has no name, it goes to the other
  // end.
  bool send(Bytes datagram) const noexcept;
  bool send(Bytes datagram, const PeerAddress& to) const noexcept;

 private:
  struct Batch {
    std::array<std::array<std::byte, wire_bytes_max + 1>, batch_max> bytes;  // one more: what is too long shows
    std::array<PeerAddress, batch_max> from;
    std::array<iovec, batch_max> parts{};
    std::array<mmsghdr, batch_max> messages{};
  };
  OwnedDescriptor descriptor_;
  std::unique_ptr<Batch> batch_ = std::make_unique<Batch>();
};

}  // namespace kadans
