// Where the calling thread runs, and how urgently. Both are wishes: 0, or errno of a system that refuses.
#pragma once

namespace kadans {

// It, and what it starts from here on, leaves this CPU to others, if there is another.
int leave_cpu(int cpu) noexcept;
// SCHED_FIFO at this priority.
int take_priority(int priority) noexcept;
// When memory runs out, the system takes this process before others.
void be_first_victim() noexcept;
// The process may map at most so much more than it has now.
int limit_memory(unsigned long long more_bytes) noexcept;

}  // namespace kadans
