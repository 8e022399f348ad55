// To be called between two looks in a loop that waits for time or for another thread: leaves the core to its other
// hardware thread.
#pragma once

namespace kadans {

inline void relax() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace kadans
