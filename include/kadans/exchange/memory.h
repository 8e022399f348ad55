// The memory through which the templates of this folder speak from thread to thread, as their last parameter: the
// machine's, unless a checker looks on. tests/interleavings gives them one that is as weak as the language allows.
#pragma once

#include <atomic>
#include <type_traits>

namespace kadans {

struct MachineMemory {
  // A number that several threads touch, through at() alone. It is a plain one, so that what holds it stays trivially
  // copyable, which std::atomic would not.
  template <typename T>
  using Word = T;

  // Of a word, also of a const one: atomic_ref wants a non-const object even to load, and words are never const
  // objects.
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
