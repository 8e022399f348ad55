// A bounded queue from one producer to one consumer. A batch goes in whole or not at all and becomes visible at once,
// so a reader never sees half a transaction. Full means refused: nothing blocks, nothing is overwritten.
//
// Wait-free on both sides, trivially copyable and without pointers, so that it also works in shared memory.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace kadans {

template <typename T, std::size_t Capacity>
class Ring {
  static_assert(std::is_trivially_copyable_v<T>, "T crosses threads by plain copy");
  static_assert(Capacity >= 2 && (Capacity & (Capacity - 1)) == 0, "the capacity is a power of two");
  static_assert(Capacity <= (std::size_t{1} << 31), "positions are counted modulo 2^32");
  static_assert(std::atomic_ref<std::uint32_t>::is_always_lock_free, "also on 32-bit machines");

 public:
  // Producer thread only. False, and nothing is queued, when the batch does not fit.
  [[nodiscard]] bool try_push(std::span<const T> batch) noexcept {
    if (batch.size() > free()) return false;
    const std::uint32_t head = head_;
    for (std::size_t i = 0; i < batch.size(); ++i) slots_[(head + i) & mask] = batch[i];
    std::atomic_ref(head_).store(head + static_cast<std::uint32_t>(batch.size()), std::memory_order_release);
    return true;
  }
  // Producer thread only.
  [[nodiscard]] bool try_push(const T& value) noexcept { return try_push(std::span<const T>(&value, 1)); }

  // Producer thread only: places left. It can only grow until the producer pushes again.
  std::size_t free() const noexcept { return Capacity - (head_ - load(tail_)); }

  // Consumer thread only: elements waiting. It can only grow until the consumer pops.
  std::size_t size() const noexcept { return load(head_) - tail_; }

  // Consumer thread only: element `i` of those waiting, i < size(); it stays in the queue.
  const T& peek(std::size_t i = 0) const noexcept { return slots_[(tail_ + i) & mask]; }

  // Consumer thread only: removes the first `count` elements, count <= size().
  void drop(std::size_t count) noexcept {
    std::atomic_ref(tail_).store(tail_ + static_cast<std::uint32_t>(count), std::memory_order_release);
  }

  // Consumer thread only. False, and `value` untouched, when nothing waits.
  [[nodiscard]] bool try_pop(T& value) noexcept {
    if (size() == 0) return false;
    value = peek();
    drop(1);
    return true;
  }

  static constexpr std::size_t capacity() noexcept { return Capacity; }

 private:
  static constexpr std::size_t cache_line = 64;
  static constexpr std::uint32_t mask = static_cast<std::uint32_t>(Capacity - 1);

  // atomic_ref wants a non-const object even to load; the positions are never const objects.
  static std::uint32_t load(const std::uint32_t& position) noexcept {
    return std::atomic_ref(const_cast<std::uint32_t&>(position)).load(std::memory_order_acquire);
  }

  alignas(cache_line) std::uint32_t head_ = 0;  // pushed so far, modulo 2^32; written by the producer
  alignas(cache_line) std::uint32_t tail_ = 0;  // popped so far, modulo 2^32; written by the consumer
  alignas(cache_line) std::array<T, Capacity> slots_{};
};

}  // namespace kadans
