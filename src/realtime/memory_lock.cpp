#include "kadans/realtime/memory_lock.h"

#include <cerrno>
#include <cstdlib>

#include <malloc.h>
#include <sys/mman.h>

namespace kadans {

int lock_memory(std::size_t reserve_bytes) noexcept {
  constexpr std::size_t page = 4096;
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  auto* const reserve = static_cast<volatile char*>(std::malloc(reserve_bytes));
  for (std::size_t i = 0; reserve != nullptr && i < reserve_bytes; i += page) reserve[i] = 0;
  std::free(const_cast<char*>(reserve));
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
}

}  // namespace kadans
