#include "doorbell.h"

#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kadans {

Doorbell::~Doorbell() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::pair<Doorbell, Doorbell> Doorbell::make_pair() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "no sockets between two processes");
  return {Doorbell(ends[0]), Doorbell(ends[1])};
}

void Doorbell::ring() const noexcept {
  const char ring = 1;
  (void)!send(descriptor_, &ring, 1, MSG_NOSIGNAL | MSG_DONTWAIT);  // full: there are rings enough
}

Doorbell::Heard Doorbell::wait(std::int64_t timeout_ns) noexcept {
  constexpr std::int64_t second_ns = 1'000'000'000;
  pollfd waited{descriptor_, POLLIN, 0};
  const timespec timeout{static_cast<std::time_t>(timeout_ns / second_ns), static_cast<long>(timeout_ns % second_ns)};
  if (ppoll(&waited, 1, timeout_ns < 0 ? nullptr : &timeout, nullptr) <= 0) return Heard::nothing;
  std::array<char, 256> rings{};
  const ssize_t got = recv(descriptor_, rings.data(), rings.size(), MSG_DONTWAIT);
  if (got > 0) return Heard::ring;
  return got < 0 && (errno == EAGAIN || errno == EINTR) ? Heard::nothing : Heard::end;
}

}  // namespace kadans
