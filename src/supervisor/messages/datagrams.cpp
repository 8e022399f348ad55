#include "datagrams.h"

#include <algorithm>
#include <cstring>
#include <ctime>

#include <sys/socket.h>
#include <sys/uio.h>

#include "plant/socket_address.h"

namespace kadans {
namespace {

constexpr std::int64_t waited_max_ns = 1'000'000'000;  // longer ones are from a clock that was set meanwhile

}  // namespace

Datagrams::Datagrams(const std::string& listen, const std::vector<std::string>& send_to) {
  if (!listen.empty()) {
    listening_ = OwnedDescriptor(listening_socket(listen));
    const int yes = 1;
    (void)setsockopt(listening_.number(), SOL_SOCKET, SO_TIMESTAMPNS, &yes, sizeof yes);
  }
  for (const std::string& place : send_to) sending_.emplace_back(connected_socket(place));
}

// The system tells when a datagram came, by another clock than ours: what counts is how long ago that is.
bool Datagrams::receive(std::int64_t now_ns, std::string_view& datagram, std::int64_t& came_ns) noexcept {
  if (!listening_) return false;
  alignas(cmsghdr) std::array<char, 128> beside{};
  iovec to{.iov_base = bytes_.data(), .iov_len = bytes_.size()};
  msghdr head{};
  head.msg_iov = &to;
  head.msg_iovlen = 1;
  head.msg_control = beside.data();
  head.msg_controllen = beside.size();
  const ssize_t size = recvmsg(listening_.number(), &head, MSG_DONTWAIT);
  if (size < 0) return false;
  datagram = {bytes_.data(), static_cast<std::size_t>(size)};
  came_ns = now_ns;
  timespec now{}, came{};
  clock_gettime(CLOCK_REALTIME, &now);
  for (const cmsghdr* part = CMSG_FIRSTHDR(&head); part != nullptr;
       part = CMSG_NXTHDR(&head, const_cast<cmsghdr*>(part))) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SO_TIMESTAMPNS) continue;
    std::memcpy(&came, CMSG_DATA(part), sizeof came);
    const std::int64_t waited_ns = (now.tv_sec - came.tv_sec) * 1'000'000'000LL + (now.tv_nsec - came.tv_nsec);
    came_ns -= std::clamp<std::int64_t>(waited_ns, 0, waited_max_ns);
  }
  return true;
}

bool Datagrams::send(std::int64_t /*now_ns*/, std::string_view datagram) noexcept {
  bool all = true;
  for (const OwnedDescriptor& descriptor : sending_) {
    all = ::send(descriptor.number(), datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
              static_cast<ssize_t>(datagram.size()) &&
          all;
  }
  return all;
}

}  // namespace kadans
