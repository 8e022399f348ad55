#include "datagram_socket.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <utility>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <poll.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

[[noreturn]] void fail(const std::string& message) { throw InputError({.message = message}); }

struct HostPort {
  std::string host, port;
};

HostPort parse(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  HostPort place{text.substr(0, colon == std::string::npos ? 0 : colon),
                 colon == std::string::npos ? "" : text.substr(colon + 1)};
  const bool digits =
      !place.port.empty() && place.port.size() <= 5 && place.port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::stoul(place.port) > 65535) fail("'" + text + "' must be HOST:PORT, such as 192.168.0.10:7100");
  if (place.host.size() > 1 && place.host.front() == '[' && place.host.back() == ']')
    place.host = place.host.substr(1, place.host.size() - 2);
  return place;
}

struct AddressList {
  addrinfo* first = nullptr;
  AddressList() = default;
  AddressList(const AddressList&) = delete;
  AddressList& operator=(const AddressList&) = delete;
  ~AddressList() {
    if (first != nullptr) freeaddrinfo(first);
  }
};

// Opens and tries `attach` (bind or connect) on each address of the place until one is taken.
template <typename Attach>
int open_at(const std::string& text, int flags, Attach attach) {
  const HostPort place = parse(text);
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = flags | AI_NUMERICSERV;
  AddressList list;
  const char* host = place.host.empty() ? nullptr : place.host.c_str();
  const int unknown = getaddrinfo(host, place.port.c_str(), &wanted, &list.first);
  if (unknown != 0) fail("'" + text + "': " + gai_strerror(unknown));
  int error = 0;
  for (const addrinfo* at = list.first; at != nullptr; at = at->ai_next) {
    const int descriptor = socket(at->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, at->ai_protocol);
    if (descriptor >= 0 && attach(descriptor, at->ai_addr, at->ai_addrlen) == 0) {
      const int urgent = IPTOS_LOWDELAY;  // a wish, nothing more
      (void)setsockopt(descriptor, IPPROTO_IP, IP_TOS, &urgent, sizeof urgent);
      return descriptor;
    }
    error = errno;
    if (descriptor >= 0) close(descriptor);
  }
  fail("'" + text + "': " + std::system_category().message(error));
}

}  // namespace

bool PeerAddress::operator==(const PeerAddress& other) const noexcept {
  return size == other.size && std::memcmp(&address, &other.address, size) == 0;
}

std::string PeerAddress::text() const {
  char host[NI_MAXHOST], port[NI_MAXSERV];
  const auto* const raw = reinterpret_cast<const sockaddr*>(&address);
  if (size == 0 || (address.ss_family != AF_INET && address.ss_family != AF_INET6) ||
      getnameinfo(raw, size, host, sizeof host, port, sizeof port, NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return "the other end";
  const std::string name = host;
  return (name.find(':') == std::string::npos ? name : "[" + name + "]") + ":" + port;
}

struct DatagramSocket::Batch {
  std::array<std::array<std::byte, wire_bytes_max + 1>, batch_max> bytes;  // one more: what is too long shows
  std::array<PeerAddress, batch_max> from;
  std::array<iovec, batch_max> parts{};
  std::array<mmsghdr, batch_max> messages{};
};

DatagramSocket::DatagramSocket(int descriptor) : descriptor_(descriptor), batch_(std::make_unique<Batch>()) {}

DatagramSocket DatagramSocket::listening(const std::string& place) {
  return DatagramSocket(open_at(place, AI_PASSIVE, bind));
}

DatagramSocket DatagramSocket::connected(const std::string& place) {
  return DatagramSocket(open_at(place, 0, connect));
}

DatagramSocket::DatagramSocket(DatagramSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), batch_(std::move(other.batch_)) {}

DatagramSocket::~DatagramSocket() {
  if (descriptor_ >= 0) close(descriptor_);
}

void DatagramSocket::wait(int milliseconds) const noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::milliseconds(milliseconds);
  for (int left = milliseconds; left >= 0;) {
    pollfd wanted{descriptor_, POLLIN, 0};
    if (poll(&wanted, 1, left) <= 0 || (wanted.revents & POLLIN) != 0) return;
    int error = 0;  // that nobody listens there is no reason to wait less: somebody may soon
    socklen_t size = sizeof error;
    if (getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &error, &size) != 0 || error == 0) return;
    left = static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count());
  }
}

std::size_t DatagramSocket::receive() noexcept {
  for (std::size_t i = 0; i < batch_max; ++i) {
    batch_->parts[i] = {batch_->bytes[i].data(), batch_->bytes[i].size()};
    msghdr& head = batch_->messages[i].msg_hdr;
    head = {};
    head.msg_name = &batch_->from[i].address;
    head.msg_namelen = sizeof batch_->from[i].address;
    head.msg_iov = &batch_->parts[i];
    head.msg_iovlen = 1;
  }
  int count = recvmmsg(descriptor_, batch_->messages.data(), batch_max, MSG_DONTWAIT, nullptr);
  // The answer to something sent before (nobody listens there) is told once and stands before what came.
  if (count < 0 && errno == ECONNREFUSED)
    count = recvmmsg(descriptor_, batch_->messages.data(), batch_max, MSG_DONTWAIT, nullptr);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    batch_->from[at].size = batch_->messages[at].msg_hdr.msg_namelen;
  }
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

Bytes DatagramSocket::datagram(std::size_t index) const noexcept {
  const std::size_t length = batch_->messages[index].msg_len;
  if (length > wire_bytes_max) return {};
  return {batch_->bytes[index].data(), length};
}

const PeerAddress& DatagramSocket::from(std::size_t index) const noexcept { return batch_->from[index]; }

bool DatagramSocket::send(Bytes datagram) const noexcept { return send(datagram, {}); }

bool DatagramSocket::send(Bytes datagram, const PeerAddress& to) const noexcept {
  const auto* const address = to.size == 0 ? nullptr : reinterpret_cast<const sockaddr*>(&to.address);
  const ssize_t sent =
      sendto(descriptor_, datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL, address, to.size);
  return sent == static_cast<ssize_t>(datagram.size());
}

}  // namespace kadans
