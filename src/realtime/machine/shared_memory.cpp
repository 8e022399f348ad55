#include "shared_memory.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kadans {
namespace {

[[noreturn]] void fail(int error) { throw std::system_error(error, std::generic_category(), "no shared memory"); }

}  // namespace

SharedMemory::SharedMemory(std::size_t bytes)
    : descriptor_(memfd_create("kadans", MFD_CLOEXEC | MFD_ALLOW_SEALING)), bytes_(bytes) {
  if (descriptor_ < 0) fail(errno);
  // Sealed: a side that cut it short would make the other one die of SIGBUS.
  if (ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0 ||
      fcntl(descriptor_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    const int error = errno;
    close(descriptor_);
    fail(error);
  }
  map();
}

SharedMemory::SharedMemory(int descriptor, std::size_t bytes) : descriptor_(descriptor), bytes_(bytes) {
  struct stat size = {};
  if (fstat(descriptor_, &size) != 0 || static_cast<std::size_t>(size.st_size) < bytes) {
    close(descriptor_);
    fail(EINVAL);
  }
  map();
}

void SharedMemory::map() {
  memory_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (memory_ != MAP_FAILED) return;
  const int error = errno;
  close(descriptor_);
  fail(error);
}

SharedMemory::~SharedMemory() {
  munmap(memory_, bytes_);
  close(descriptor_);
}

}  // namespace kadans
