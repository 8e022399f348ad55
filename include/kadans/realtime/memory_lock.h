// Keeps the program's memory where it is: no page fault may happen in a real-time thread.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace kadans {

// Before the threads are started, when all is built. The heap keeps `reserve_bytes` ready and gives nothing back to the
// system; then everything mapped, and all to come, stays in memory. With `unused`, some is left out, of which stays
// what is touched: shared libraries whose file names begin like one of them, which no real-time thread calls; the
// layers that are SOFT (cmake/KadansLayer.cmake); the tables that only exceptions read; what is mapped later, so that a
// real-time thread has to touch its stack first. Returns 0, or the errno of what was refused; then nothing is locked,
// so that threads and memory can still be had.
[[nodiscard]] int lock_memory(std::size_t reserve_bytes, std::span<const std::string_view> unused = {}) noexcept;

}  // namespace kadans
