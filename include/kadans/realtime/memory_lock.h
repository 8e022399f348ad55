// Keeps the program's memory where it is: no page fault may happen in a real-time thread.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace kadans {

// Before the threads are started, when all is built. The heap keeps `reserve_bytes` ready and gives nothing back to the
// system; then everything mapped, and all to come, stays in memory. With `unused`, shared libraries whose file names
// begin like one of them, which no real-time thread calls, and the tables that only exceptions read are left out: of
// those stays what is touched. Returns 0, or the errno of what was refused.
[[nodiscard]] int lock_memory(std::size_t reserve_bytes, std::span<const std::string_view> unused = {}) noexcept;

}  // namespace kadans
