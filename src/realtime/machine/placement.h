// Where a process and its threads run and what memory they have: CPU, priority, limits, and memory that is locked. The
// system may refuse: most functions return 0, or errno.
#pragma once

#include <cstddef>

namespace kadans {

// The calling thread, and what it starts from now on, no longer uses this CPU, if there is another one.
int leave_cpu(int cpu) noexcept;
// SCHED_FIFO at this priority.
int take_priority(int priority) noexcept;
// When memory runs out, the system kills this process before others.
void be_first_victim() noexcept;
// The process may map at most this much more memory than it has now.
int limit_memory(unsigned long long more_bytes) noexcept;

// Keeps the program's memory where it is: no page fault may happen in a real-time thread.
//
// Before the threads are started, when all is built. The heap keeps `reserve_bytes` ready and gives nothing back to the
// system; everything that is mapped comes into memory and stays; what is mapped later stays from its first touch on, so
// that a real-time thread touches its stack first. Returns 0, or the errno of what was refused; then nothing is locked,
// so that threads and memory can still be had.
[[nodiscard]] int lock_memory(std::size_t reserve_bytes) noexcept;

// What is left of the calling thread's stack, but for a reserve at its end, comes into memory, or as much as a beat can
// need: a larger stack is for Lua's and the model's rarest.
void touch_stack() noexcept;

}  // namespace kadans
