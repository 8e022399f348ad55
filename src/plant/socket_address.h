// Addresses of datagram sockets, and sockets that are opened at them. Before the loop.
#pragma once

#include <string>

#include <sys/socket.h>

namespace kadans {

struct PeerAddress {
  sockaddr_storage address{};
  socklen_t size = 0;  // 0: without a name, the other end of a connected socket

  bool operator==(const PeerAddress& other) const noexcept;
  std::string text() const;  // "10.0.0.2:7000"
};

// A descriptor of a socket for datagrams. The place is "host:port", "[::1]:7000", or ":7000" for every address of this
// machine. Throws InputError that says what is wrong with the place, or what the system said.
int listening_socket(const std::string& place);
int connected_socket(const std::string& place);

}  // namespace kadans
