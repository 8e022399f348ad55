#include "kadans/realtime/memory_lock.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <link.h>
#include <malloc.h>
#include <sys/mman.h>

// Bounds of what cmake/soft_layers.ld.in puts apart; null in a program that is linked without it.
extern "C" {
[[gnu::weak]] extern const std::byte kadans_soft_code_begin[], kadans_soft_code_end[];
[[gnu::weak]] extern const std::byte kadans_soft_constants_begin[], kadans_soft_constants_end[];
}

namespace kadans {
namespace {

constexpr std::size_t page = 4096;

struct Range {
  std::uintptr_t begin = 0, end = 0;
};

// What may stay out of memory until it is touched, in pages.
struct LeftOut {
  std::span<const std::string_view> unused;
  std::array<Range, 256> ranges;
  std::size_t count = 0;

  void add(const std::byte* begin, const std::byte* end) noexcept {
    add(reinterpret_cast<std::uintptr_t>(begin), reinterpret_cast<std::uintptr_t>(end), false);
  }

  // What was touched of it so far goes too, if nobody can have written to it.
  void add(std::uintptr_t begin, std::uintptr_t end, bool written) noexcept {
    begin = (begin + page - 1) / page * page;
    if (count == ranges.size() || begin >= end) return;
    ranges[count++] = {begin, end};
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader tells it as a number
    if (!written) (void)madvise(reinterpret_cast<void*>(begin), (end - begin) / page * page, MADV_DONTNEED);
  }
};

// Of an unused library all; of the others the tables that only an exception reads: they end the segment that they are
// in.
int leave_out(dl_phdr_info* info, std::size_t, void* target) noexcept {
  LeftOut& out = *static_cast<LeftOut*>(target);
  const char* const slash = std::strrchr(info->dlpi_name, '/');
  const std::string_view file = slash == nullptr ? info->dlpi_name : slash + 1;
  const bool unused = std::ranges::any_of(out.unused, [&](std::string_view name) { return file.starts_with(name); });
  const std::span segments(info->dlpi_phdr, info->dlpi_phnum);
  const auto tables = std::ranges::find(segments, ElfW(Word){PT_GNU_EH_FRAME}, &ElfW(Phdr)::p_type);
  for (const ElfW(Phdr) & segment : segments) {
    if (segment.p_type != PT_LOAD) continue;
    const std::uintptr_t begin = info->dlpi_addr + segment.p_vaddr, end = begin + segment.p_memsz;
    if (unused) {
      out.add(begin, end, (segment.p_flags & PF_W) != 0);
    } else if (tables != segments.end() && segment.p_flags == PF_R) {
      const std::uintptr_t at = info->dlpi_addr + tables->p_vaddr;
      if (at >= begin && at < end) out.add(at, end, false);
    }
  }
  return 0;
}

int lock(Range range) noexcept {
  if (range.begin >= range.end) return 0;
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the system writes it as a number
  return mlock(reinterpret_cast<const void*>(range.begin), range.end - range.begin) == 0 ? 0 : errno;
}

// The parts of a mapping that are not left out; `out` ascends.
int lock_rest(Range mapping, std::span<const Range> out) noexcept {
  int refused = 0;
  for (const Range& range : out) {
    if (range.end <= mapping.begin || range.begin >= mapping.end) continue;
    refused = std::max(refused, lock({mapping.begin, range.begin}));
    mapping.begin = std::min(mapping.end, (range.end + page - 1) / page * page);
  }
  return std::max(refused, lock(mapping));
}

// A line of /proc/self/maps: "7f12a000-7f12b000 r-xp 00000000 fe:00 1234   /usr/lib/libm.so.6". What the kernel lends
// ("[vdso]") is always there.
bool parse(const char* line, Range& mapping) noexcept {
  unsigned long long begin = 0, end = 0;
  char rights[5]{};
  if (std::sscanf(line, "%llx-%llx %4s", &begin, &end, rights) != 3) return false;
  mapping = {static_cast<std::uintptr_t>(begin), static_cast<std::uintptr_t>(end)};
  return rights[0] == 'r' && std::strstr(line, "[v") == nullptr;
}

// Everything mapped but for what is left out comes into memory now; that does when it is touched. All of it stays.
int lock_used(std::span<const std::string_view> unused) noexcept {
  LeftOut out{.unused = unused, .ranges = {}};
  dl_iterate_phdr(leave_out, &out);
  out.add(kadans_soft_code_begin, kadans_soft_code_end);
  out.add(kadans_soft_constants_begin, kadans_soft_constants_end);
  const std::span<Range> ranges(out.ranges.data(), out.count);
  std::ranges::sort(ranges, {}, &Range::begin);
  if (mlockall(MCL_CURRENT | MCL_ONFAULT) != 0) return errno;
  std::FILE* const maps = std::fopen("/proc/self/maps", "re");
  if (maps == nullptr) return errno;
  int refused = 0;
  char line[512];
  Range mapping;
  while (std::fgets(line, sizeof line, maps) != nullptr) {
    if (parse(line, mapping)) refused = std::max(refused, lock_rest(mapping, ranges));
  }
  (void)std::fclose(maps);
  return refused;
}

// With what is locked, a thread's stack must still fit the limit: else no thread could be started.
bool has_room_to_come() noexcept {
  constexpr std::size_t stacks_bytes = std::size_t{64} << 20U;
  void* const room = mmap(nullptr, stacks_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return room != MAP_FAILED && munmap(room, stacks_bytes) == 0;
}

}  // namespace

int lock_memory(std::size_t reserve_bytes, std::span<const std::string_view> unused) noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  auto* const reserve = static_cast<volatile char*>(std::malloc(reserve_bytes));
  for (std::size_t i = 0; reserve != nullptr && i < reserve_bytes; i += page) reserve[i] = 0;
  std::free(const_cast<char*>(reserve));
  int refused = 0;
  if (unused.empty()) {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) refused = errno;
  } else {
    refused = lock_used(unused);
    if (refused == 0 && mlockall(MCL_FUTURE | MCL_ONFAULT) != 0) refused = errno;
  }
  if (refused == 0 && !has_room_to_come()) refused = ENOMEM;
  if (refused != 0) (void)munlockall();
  return refused;
}

}  // namespace kadans
