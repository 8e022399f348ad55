// The seam to what a periodic task waits on: a clock that can also be slept on.
//
// Everything that differs between operating systems, between wall and virtual time, and between a test and the robot
// is behind it: POSIX (posix_wait.h), threads on virtual time (virtual_time.h), a fake in tests. Xenomai's POSIX skin
// replaces the POSIX calls when the program is linked; EVL would be one more class. docs/realtime.md says how.
#pragma once

#include <cstdint>

#include "engine/clock.h"

namespace kadans {

class Wait : public Clock {
 public:
  // The thread that will wait, before its first until() and after its last.
  virtual void begin() noexcept {}
  virtual void end() noexcept {}
  // The same thread. Returns at time_ns or later, at once when that is past; earlier only when the clock stands still.
  virtual void until(std::int64_t time_ns) noexcept = 0;
};

// To be called between two looks in a loop that waits for time or for another thread: leaves the core to its other
// hardware thread.
inline void relax() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace kadans
