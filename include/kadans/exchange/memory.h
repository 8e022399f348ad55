// The memory through which the templates of this folder exchange data between threads; it is their last parameter. This
// is the machine's memory. The checker in tests/interleavings gives them one that is as weak as the language allows.
#pragma once

#include <atomic>
#include <type_traits>

namespace kadans {

struct MachineMemory {
  // A number that several threads access, through at() only. It is a plain number, so that a type that holds it stays
  // trivially copyable; with std::atomic it would not.
  template <typename T>
  using Word = T;

  // Atomic access to a word, also through a const reference. atomic_ref needs a non-const object even to load; the
  // words themselves are never const objects.
  template <typename T>
  static std::atomic_ref<T> at(const T& word) noexcept {
    static_assert(std::atomic_ref<T>::is_always_lock_free, "also on 32-bit machines");
    return std::atomic_ref<T>(const_cast<T&>(word));
  }

  // Whether a value may cross threads by plain copy.
  template <typename T>
  static constexpr bool can_cross = std::is_trivially_copyable_v<T>;
};

}  // namespace kadans
