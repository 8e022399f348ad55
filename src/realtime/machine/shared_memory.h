// Memory that two processes share, and the doorbell by which they wake each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "signal/owned_descriptor.h"

namespace kadans {

// Memory that two processes share. It has no name, so that nobody else finds it and nothing of it outlives them.
class SharedMemory {
 public:
  // New memory, all zero. Its descriptor is closed in programs that are started. Throws std::system_error.
  explicit SharedMemory(std::size_t bytes);
  // The memory of another process; takes the descriptor over. Throws std::system_error, also when it is smaller.
  SharedMemory(int descriptor, std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;

  void* get() const noexcept { return memory_; }
  int descriptor() const noexcept { return descriptor_.number(); }

 private:
  void map();

  OwnedDescriptor descriptor_;
  std::size_t bytes_;
  void* memory_ = nullptr;
};

// How two processes that share memory wake each other: each has one end of a pair of connected sockets. A ring says
// that there is something to look at and means nothing else. Rings that nobody has waited for count as one.
//
// Why sockets and not a futex in the shared memory: the system closes the other end when its process dies, whatever
// kills it, so that a process that waits wakes at once and not only after its timeout. And no wait depends on memory
// that the other side can overwrite. One thread per end.
class Doorbell {
 public:
  enum class Heard : std::uint8_t { nothing, ring, end };  // end: the other side is gone

  // Takes the descriptor over.
  explicit Doorbell(int descriptor) noexcept : descriptor_(descriptor) {}

  // Both ends, closed in programs that are started. Throws std::system_error.
  static std::pair<Doorbell, Doorbell> make_pair();

  // Never blocks. Has no effect when the other side is gone.
  void ring() const noexcept;
  // Waits for a ring for at most this long; < 0: for ever. Takes all rings that there are, but only a few at most: the
  // other side cannot keep it here.
  Heard wait(std::int64_t timeout_ns) noexcept;

  int descriptor() const noexcept { return descriptor_.number(); }

 private:
  OwnedDescriptor descriptor_;
};

}  // namespace kadans
