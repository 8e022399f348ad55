#include "warm_up.h"

#include <chrono>

#include "tick_code.h"

// The linker names the ends of a section so.
extern "C" const std::byte __start_kadans_tick[], __stop_kadans_tick[];  // NOLINT(bugprone-reserved-identifier)

namespace kadans {

std::span<const std::byte> tick_code() noexcept { return {__start_kadans_tick, __stop_kadans_tick}; }

KADANS_TICK_CODE void WarmUp::read(std::span<const std::byte> memory) noexcept {
  const std::byte* at = memory.data();
  const std::byte* const end = at + memory.size();
  while (at < end) {
    (void)*static_cast<const volatile std::byte*>(at);
    at += line_bytes - reinterpret_cast<std::uintptr_t>(at) % line_bytes;
  }
}

// A clock's page and code would be cold too, so a register where there is one.
KADANS_TICK_CODE std::uint64_t WarmUp::cycles() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_ia32_rdtsc();
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

KADANS_TICK_CODE void WarmUp::go() const noexcept {
  for (std::size_t i = 0; i < count_; ++i) read(ranges_[i]);
}

void WarmUp::add(std::span<const std::byte> memory) noexcept {
  if (!memory.empty() && count_ < ranges_.size()) ranges_[count_++] = memory;
}

}  // namespace kadans
