// How two processes wake each other over what they share in memory: one end each of a pair of connected sockets. A ring
// says that there is something to look at and means nothing else; rings that nobody waited for count as one.
//
// Sockets and not a futex in the shared memory: the system closes the other end when its process dies, whatever kills
// it, so that who waits wakes at once instead of at the end of his patience; and the other side can scribble over no
// memory that a wait depends on. One thread an end.
#pragma once

#include <cstdint>
#include <utility>

namespace kadans {

class Doorbell {
 public:
  enum class Heard : std::uint8_t { nothing, ring, end };  // end: the other side is gone

  // Takes the descriptor over.
  explicit Doorbell(int descriptor) noexcept : descriptor_(descriptor) {}
  ~Doorbell();
  Doorbell(Doorbell&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Doorbell& operator=(Doorbell&&) = delete;

  // Both ends, closed in programs that are started. Throws std::system_error.
  static std::pair<Doorbell, Doorbell> make_pair();

  // Never blocks; to ring where nobody is does nothing.
  void ring() const noexcept;
  // Waits for a ring for at most this long; < 0: for ever. Takes all rings there are, but no more than a few: the other
  // side cannot keep it here.
  Heard wait(std::int64_t timeout_ns) noexcept;

  int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace kadans
