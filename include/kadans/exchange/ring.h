// A bounded queue from one producer to one consumer. A batch goes in whole or not at all and becomes visible at once,
// so a reader never sees half a transaction. A batch that does not fit is refused: nothing blocks, nothing is
// overwritten.
//
// Two positions count the elements that were pushed and popped, modulo 2^32; the difference is what waits. Each side
// stores its own position with release after it has touched the slots, and loads the other's with acquire before it
// touches them. It loads its own position relaxed, because nobody else stores there. Each order is needed:
// tests/interleavings weakens one after the other and finds what breaks.
//
// Wait-free on both sides, trivially copyable and without pointers, so that it also works in memory shared between two
// processes. Copy it only while nobody pushes or pops. A producer that is killed inside a push leaves nothing behind; a
// consumer that is killed inside a pop may have used an element that its successor finds again.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kadans/exchange/memory.h"

namespace kadans {

template <typename T, std::size_t Capacity, typename Memory = MachineMemory>
class Ring {
  static_assert(Memory::template can_cross<T>, "T crosses threads by plain copy");
  static_assert(Capacity >= 2 && (Capacity & (Capacity - 1)) == 0, "the capacity is a power of two");
  static_assert(Capacity <= (std::size_t{1} << 31), "positions are counted modulo 2^32");

 public:
  // Producer thread only. False, and nothing is queued, when the batch does not fit. The batch must not lie in the ring
  // itself.
  [[nodiscard]] bool try_push(std::span<const T> batch) noexcept { return try_push(batch, {}); }
  // Producer thread only. The same for a batch that lies in two places, `first` before `second`.
  [[nodiscard]] bool try_push(std::span<const T> first, std::span<const T> second) noexcept {
    const std::size_t size = first.size() + second.size();
    if (size > free()) return false;
    const std::uint32_t head = own(head_);
    copy_in(head, first);
    copy_in(head + static_cast<std::uint32_t>(first.size()), second);
    Memory::at(head_).store(head + static_cast<std::uint32_t>(size), std::memory_order_release);
    return true;
  }
  // Producer thread only. The same in many places; two are written out above, because each control tick pushes so.
  [[nodiscard]] bool try_push_all(std::span<const std::span<const T>> pieces) noexcept {
    std::size_t size = 0;
    for (const std::span<const T> piece : pieces) size += piece.size();
    if (size > free()) return false;
    std::uint32_t head = own(head_);
    for (const std::span<const T> piece : pieces) {
      copy_in(head, piece);
      head += static_cast<std::uint32_t>(piece.size());
    }
    Memory::at(head_).store(head, std::memory_order_release);
    return true;
  }
  // Producer thread only.
  [[nodiscard]] bool try_push(const T& value) noexcept { return try_push(std::span<const T>(&value, 1)); }

  // Producer thread only: places left. It can only grow until the producer pushes again.
  std::size_t free() const noexcept {
    return Capacity - (own(head_) - Memory::at(tail_).load(std::memory_order_acquire));
  }

  // Consumer thread only: elements waiting. It can only grow until the consumer pops.
  std::size_t size() const noexcept { return Memory::at(head_).load(std::memory_order_acquire) - own(tail_); }

  // Consumer thread only: element `i` of those waiting, i < size() as last asked; it stays in the queue. The reference
  // holds until the element is dropped.
  const T& peek(std::size_t i = 0) const noexcept { return slots_[(own(tail_) + i) & mask]; }

  // Consumer thread only: the elements from `i` on; i + to.size() <= size() as last asked. They stay in the queue.
  void copy_out(std::size_t i, std::span<T> to) const noexcept {
    const std::size_t start = (own(tail_) + i) & mask;
    const std::size_t before_end = std::min(to.size(), Capacity - start);
    std::copy_n(slots_.begin() + static_cast<std::ptrdiff_t>(start), before_end, to.begin());
    std::copy_n(slots_.begin(), to.size() - before_end, to.begin() + static_cast<std::ptrdiff_t>(before_end));
  }

  // Consumer thread only: removes the first `count` elements, count <= size() as last asked.
  void drop(std::size_t count) noexcept {
    Memory::at(tail_).store(own(tail_) + static_cast<std::uint32_t>(count), std::memory_order_release);
  }

  // Consumer thread only. False, and `value` untouched, when nothing waits.
  [[nodiscard]] bool try_pop(T& value) noexcept {
    if (size() == 0) return false;
    value = peek();
    drop(1);
    return true;
  }

  // While nobody pushes or pops: hands all that it holds to `bytes` (state_bytes.h).
  void pass_state(auto& bytes) noexcept { bytes(head_, tail_, slots_); }

  static constexpr std::size_t capacity() noexcept { return Capacity; }

 private:
  static constexpr std::size_t cache_line = 64;
  static constexpr std::uint32_t mask = static_cast<std::uint32_t>(Capacity - 1);

  // Copies in at most two pieces, the second from the start of the slots.
  [[gnu::always_inline]] void copy_in(std::uint32_t position, std::span<const T> batch) noexcept {
    const std::size_t start = position & mask;
    const std::size_t before_end = std::min(batch.size(), Capacity - start);
    std::copy_n(batch.begin(), before_end, slots_.begin() + static_cast<std::ptrdiff_t>(start));
    std::copy_n(batch.begin() + static_cast<std::ptrdiff_t>(before_end), batch.size() - before_end, slots_.begin());
  }

  using Position = typename Memory::template Word<std::uint32_t>;
  static std::uint32_t own(const Position& position) noexcept {
    return Memory::at(position).load(std::memory_order_relaxed);
  }

  alignas(cache_line) Position head_{};  // pushed so far, modulo 2^32; written by the producer
  alignas(cache_line) Position tail_{};  // popped so far, modulo 2^32; written by the consumer
  alignas(cache_line) std::array<T, Capacity> slots_{};
};

}  // namespace kadans
