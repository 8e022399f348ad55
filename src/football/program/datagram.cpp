#include "datagram.h"

#include <array>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans::football {
namespace {

std::optional<sockaddr_in> address_of(const std::string& host, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) return std::nullopt;
  return address;
}

[[noreturn]] void refuse_place(const std::string& host, std::uint16_t port, const std::string& why) {
  throw InputError({.file = host + ":" + std::to_string(port), .message = why});
}

}  // namespace

bool is_address(const std::string& host) { return address_of(host, 0).has_value(); }

DatagramPort::DatagramPort(const std::string& host, std::uint16_t port) {
  const std::optional<sockaddr_in> address = address_of(host, port);
  if (!address) refuse_place(host, port, "is no address of IPv4, such as 127.0.0.1 or 0.0.0.0");
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) refuse_place(host, port, std::strerror(errno));  // NOLINT(concurrency-mt-unsafe): one thread
  const int yes = 1;
  (void)setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
  sockaddr_in own{};
  socklen_t size = sizeof own;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0 ||
      getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size) != 0) {
    const int error = errno;
    close(socket_);
    refuse_place(host, port, std::strerror(error));  // NOLINT(concurrency-mt-unsafe): one thread
  }
  port_ = ntohs(own.sin_port);
}

DatagramPort::~DatagramPort() { close(socket_); }

bool DatagramPort::send(const std::string& host, std::uint16_t port, Bytes bytes) const noexcept {
  const std::optional<sockaddr_in> to = address_of(host, port);
  return to && sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&*to),
                      sizeof *to) == static_cast<ssize_t>(bytes.size());
}

std::optional<Received> DatagramPort::receive() const {
  std::array<std::byte, 2048> bytes{};
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t count = recvfrom(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
  if (count < 0) return std::nullopt;
  std::array<char, INET_ADDRSTRLEN> text{};
  (void)inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size());
  return Received{text.data(), {bytes.begin(), bytes.begin() + count}};
}

}  // namespace kadans::football
