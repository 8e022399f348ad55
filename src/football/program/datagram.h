// UDP for a match over the wire: what comes is whatever anybody sends. Nothing here ever blocks. One thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "football/packet.h"

namespace kadans::football {

struct Received {
  std::string from;  // its address without the port: "127.0.0.1"
  std::vector<std::byte> bytes;
};

bool is_address(const std::string& host);  // of IPv4, in numbers: 127.0.0.1

class DatagramPort {
 public:
  // Bound to this address and port; port 0: any free one. Throws InputError that says what the system said.
  DatagramPort(const std::string& host, std::uint16_t port);
  ~DatagramPort();
  DatagramPort(const DatagramPort&) = delete;
  DatagramPort& operator=(const DatagramPort&) = delete;

  std::uint16_t port() const noexcept { return port_; }
  // False: it did not go out, as any datagram may not come in.
  bool send(const std::string& host, std::uint16_t port, Bytes bytes) const noexcept;
  std::optional<Received> receive() const;  // the oldest that waits, its first 2048 bytes

 private:
  int socket_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace kadans::football
