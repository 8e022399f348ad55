// What a loop that waits for time or for another thread does between two looks: it yields the core's other half.
#pragma once

namespace kadans {

inline void relax() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace kadans
