// Keeps the program's memory where it is: no page fault may happen in a real-time thread.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace kadans {

// To be called when everything is built, before the threads are started. The heap keeps `reserve_bytes` ready and gives
// nothing back to the system. Then everything that is mapped, now and later, stays in memory.
//
// With `unused` some parts are left out; of these only the pages that were touched stay in memory: shared libraries
// whose file names begin with one of the texts, and which no real-time thread calls; the layers that are SOFT
// (cmake/KadansLayer.cmake); the tables that only exceptions read; what is mapped later, so that a real-time thread has
// to touch its stack first.
//
// Returns 0, or the errno of a refusal; then nothing is locked, so that threads and memory are still available.
[[nodiscard]] int lock_memory(std::size_t reserve_bytes, std::span<const std::string_view> unused = {}) noexcept;

}  // namespace kadans
