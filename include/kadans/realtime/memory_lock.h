// Keeps the program's memory where it is: no page fault may happen in a real-time thread.
#pragma once

#include <cstddef>

namespace kadans {

// Before the threads are started, when all is built. The heap keeps `reserve_bytes` ready and gives nothing back to the
// system; then everything mapped, and all to come, stays in memory. Returns 0, or the errno of what was refused.
[[nodiscard]] int lock_memory(std::size_t reserve_bytes) noexcept;

}  // namespace kadans
