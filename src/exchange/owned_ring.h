// Hands things of any size from one producer to one consumer: a Ring of pointers that owns what waits in it. Neither
// side waits for the other.
#pragma once

#include <cstddef>
#include <memory>

#include "kadans/exchange/ring.h"

namespace kadans {

template <typename T, std::size_t Capacity, typename Memory = MachineMemory>
class OwnedRing {
 public:
  OwnedRing() = default;
  // To be destroyed when neither side uses it any more.
  ~OwnedRing() {
    while (try_pop() != nullptr) {
    }
  }
  OwnedRing(const OwnedRing&) = delete;
  OwnedRing& operator=(const OwnedRing&) = delete;

  // Producer thread only. False: there is no room, and `one` is freed.
  [[nodiscard]] bool try_push(std::unique_ptr<T> one) noexcept {
    if (!ring_.try_push(one.get())) return false;
    (void)one.release();
    return true;
  }
  // Consumer thread only. nullptr: nothing waits.
  [[nodiscard]] std::unique_ptr<T> try_pop() noexcept {
    T* one = nullptr;
    (void)ring_.try_pop(one);
    return std::unique_ptr<T>(one);
  }

 private:
  Ring<T*, Capacity, Memory> ring_;
};

}  // namespace kadans
