// A number that one thread changes and any thread may read: relaxed, so it orders nothing else. On the machines we know
// it costs what a plain number costs. Trivially copyable, like all that crosses threads here.
#pragma once

#include <atomic>
#include <cstdint>
#include <type_traits>

namespace kadans {

template <typename T>
class OneWriter {
  static_assert(std::atomic_ref<T>::is_always_lock_free, "also on 32-bit machines");

 public:
  OneWriter() noexcept = default;
  explicit OneWriter(T first) noexcept : value_(first) {}

  // Writer thread only.
  void set(T value) noexcept { std::atomic_ref(value_).store(value, std::memory_order_relaxed); }
  void add(T more) noexcept { set(get() + more); }
  // Any thread. atomic_ref wants a non-const object even to load; these are never const objects.
  T get() const noexcept { return std::atomic_ref(const_cast<T&>(value_)).load(std::memory_order_relaxed); }

 private:
  alignas(sizeof(T)) T value_{};
};

using Count = OneWriter<std::uint64_t>;
static_assert(std::is_trivially_copyable_v<Count>);

}  // namespace kadans
