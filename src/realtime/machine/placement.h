// The CPU and the priority of the calling thread. The system may refuse: each function returns 0, or errno.
#pragma once

namespace kadans {

// The calling thread, and what it starts from now on, no longer uses this CPU, if there is another one.
int leave_cpu(int cpu) noexcept;
// SCHED_FIFO at this priority.
int take_priority(int priority) noexcept;
// When memory runs out, the system kills this process before others.
void be_first_victim() noexcept;
// The process may map at most this much more memory than it has now.
int limit_memory(unsigned long long more_bytes) noexcept;

}  // namespace kadans
