
#include "shared_memory.h"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "signal/monotonic_clock.h"

namespace kadans {
namespace {

[[noreturn]] void fail(int error) { throw std::system_error(error, std::generic_category(), "no shared memory"); }

}  // namespace

SharedMemory::SharedMemory(std::size_t bytes)
    : descriptor_(memfd_create("kadans", MFD_CLOEXEC | MFD_ALLOW_SEALING)), bytes_(bytes) {
  // Sealed: a side that cut it short would make the other one die of SIGBUS.
  if (!descriptor_ || ftruncate(descriptor(), static_cast<off_t>(bytes)) != 0 ||
      fcntl(descriptor(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    fail(errno);
  map();
}

SharedMemory::SharedMemory(int descriptor, std::size_t bytes) : descriptor_(descriptor), bytes_(bytes) {
  struct stat size = {};
  if (fstat(descriptor, &size) != 0 || static_cast<std::size_t>(size.st_size) < bytes) fail(EINVAL);
  map();
}

void SharedMemory::map() {
  memory_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor(), 0);
  if (memory_ == MAP_FAILED) fail(errno);
}

SharedMemory::~SharedMemory() { munmap(memory_, bytes_); }

std::pair<Doorbell, Doorbell> Doorbell::make_pair() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "no sockets between two processes");
  return {Doorbell(ends[0]), Doorbell(ends[1])};
}

void Doorbell::ring() const noexcept {
  const char ring = 1;
  (void)!send(descriptor(), &ring, 1, MSG_NOSIGNAL | MSG_DONTWAIT);  // full: there are rings enough
}

Doorbell::Heard Doorbell::wait(std::int64_t timeout_ns) noexcept {
  pollfd waited{descriptor(), POLLIN, 0};
  const timespec timeout = timespec_of(timeout_ns);
  if (ppoll(&waited, 1, timeout_ns < 0 ? nullptr : &timeout, nullptr) <= 0) return Heard::nothing;
  std::array<char, 256> rings{};
  const ssize_t got = recv(descriptor(), rings.data(), rings.size(), MSG_DONTWAIT);
  if (got > 0) return Heard::ring;
  return got < 0 && (errno == EAGAIN || errno == EINTR) ? Heard::nothing : Heard::end;
}

}  // namespace kadans
