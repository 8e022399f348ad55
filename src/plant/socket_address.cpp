#include "socket_address.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <unistd.h>

#include "signal/input_file.h"

namespace kadans {
namespace {

struct HostPort {
  std::string host, port;
};

HostPort parse(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  HostPort place{text.substr(0, colon == std::string::npos ? 0 : colon),
                 colon == std::string::npos ? "" : text.substr(colon + 1)};
  const bool digits =
      !place.port.empty() && place.port.size() <= 5 && place.port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::stoul(place.port) > 65535) refuse("'" + text + "' must be HOST:PORT, such as 192.168.0.10:7100");
  if (place.host.size() > 1 && place.host.front() == '[' && place.host.back() == ']')
    place.host = place.host.substr(1, place.host.size() - 2);
  return place;
}

// Opens and tries `attach` (bind or connect) on each address of the place until one is taken.
template <typename Attach>
int open_at(const std::string& text, int flags, Attach attach) {
  const HostPort place = parse(text);
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* first = nullptr;
  const char* host = place.host.empty() ? nullptr : place.host.c_str();
  const int unknown = getaddrinfo(host, place.port.c_str(), &wanted, &first);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(first, freeaddrinfo);
  if (unknown != 0) refuse("'" + text + "': " + gai_strerror(unknown));
  int error = 0;
  for (const addrinfo* at = first; at != nullptr; at = at->ai_next) {
    const int descriptor = socket(at->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, at->ai_protocol);
    if (descriptor >= 0 && attach(descriptor, at->ai_addr, at->ai_addrlen) == 0) {
      const int urgent = IPTOS_LOWDELAY;  // a wish, nothing more
      (void)setsockopt(descriptor, IPPROTO_IP, IP_TOS, &urgent, sizeof urgent);
      return descriptor;
    }
    error = errno;
    if (descriptor >= 0) close(descriptor);
  }
  refuse("'" + text + "': " + std::system_category().message(error));
}

}  // namespace

int listening_socket(const std::string& place) { return open_at(place, AI_PASSIVE, bind); }
int connected_socket(const std::string& place) {
  return open_at(place, 0, [](int descriptor, const sockaddr* address, socklen_t size) {
    const int yes = 1;  // the address of all machines of a network is a place, too
    (void)setsockopt(descriptor, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
    return connect(descriptor, address, size);
  });
}

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

}  // namespace kadans
