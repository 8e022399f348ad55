#include "kadans/realtime/memory_lock.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <malloc.h>
#include <sys/mman.h>

namespace kadans {
namespace {

constexpr std::size_t page = 4096;

// A line of /proc/self/maps: "7f12a000-7f12b000 r-xp 00000000 fe:00 1234   /usr/lib/libm.so.6".
struct Mapping {
  std::uintptr_t begin = 0, end = 0;
  bool accessible = false;
  std::string_view file;  // without its folder; "" for memory of no file
};

bool parse(std::string_view line, Mapping& mapping) noexcept {
  unsigned long long begin = 0, end = 0;
  char rights[5]{};
  if (std::sscanf(line.data(), "%llx-%llx %4s", &begin, &end, rights) != 3) return false;
  const std::size_t slash = line.rfind('/');
  const bool ours = slash != std::string_view::npos || line.find('[') == std::string_view::npos ||
                    line.find("[heap]") != std::string_view::npos || line.find("[stack]") != std::string_view::npos;
  mapping = {static_cast<std::uintptr_t>(begin), static_cast<std::uintptr_t>(end), ours && rights[0] != '-',
             slash == std::string_view::npos ? "" : line.substr(slash + 1)};
  return true;
}

// Everything mapped but for the unused libraries comes into memory now, and stays.
int lock_used(std::span<const std::string_view> unused) noexcept {
  std::FILE* const maps = std::fopen("/proc/self/maps", "re");
  if (maps == nullptr) return errno;
  int refused = 0;
  char line[512];
  Mapping mapping;
  while (refused == 0 && std::fgets(line, sizeof line, maps) != nullptr) {
    if (!parse(line, mapping) || !mapping.accessible) continue;
    const auto fits = [&](std::string_view name) { return mapping.file.starts_with(name); };
    if (std::ranges::any_of(unused, fits)) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): it is written as a number
    if (mlock(reinterpret_cast<const void*>(mapping.begin), mapping.end - mapping.begin) != 0) refused = errno;
  }
  (void)std::fclose(maps);
  return refused;
}

}  // namespace

int lock_memory(std::size_t reserve_bytes, std::span<const std::string_view> unused) noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  auto* const reserve = static_cast<volatile char*>(std::malloc(reserve_bytes));
  for (std::size_t i = 0; reserve != nullptr && i < reserve_bytes; i += page) reserve[i] = 0;
  std::free(const_cast<char*>(reserve));
  if (unused.empty()) return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
  if (mlockall(MCL_CURRENT | MCL_ONFAULT) != 0) return errno;
  const int refused = lock_used(unused);
  return mlockall(MCL_FUTURE) == 0 ? refused : errno;
}

}  // namespace kadans
