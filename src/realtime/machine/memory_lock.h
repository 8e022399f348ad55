// Keeps the program's memory where it is: no page fault may happen in a real-time thread.
#pragma once

#include <cstddef>

namespace kadans {

// Before the threads are started, when all is built. The heap keeps `reserve_bytes` ready and gives nothing back to the
// system; everything that is mapped comes into memory and stays; what is mapped later stays from its first touch on, so
// that a real-time thread touches its stack first. Returns 0, or the errno of what was refused; then nothing is locked,
// so that threads and memory can still be had.
[[nodiscard]] int lock_memory(std::size_t reserve_bytes) noexcept;

// What is left of the calling thread's stack, but for a reserve at its end, comes into memory, or as much as a beat can
// need: a larger stack is for Lua's and the model's rarest.
void touch_stack() noexcept;

}  // namespace kadans
