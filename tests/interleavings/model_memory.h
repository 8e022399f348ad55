// A memory for the templates of exchange in which Relacy decides, at each access, which thread goes on and which of the
// values that the C++ memory model allows a load finds. A Cell that two threads touch without being ordered is a data
// race, whatever value is found, so a torn read is found even when both halves are alike.
//
// Each order that a template names is noted with its place, and one of them may be weakened. Relacy runs its threads as
// fibers of one; so nothing here is ever touched by two threads at once.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <span>

#include "relacy.h"

namespace kadans::interleavings {

// Where an order stands. The defaults are those of whoever calls what takes a Place by default.
struct Place {
  const char* file;
  const char* function;
  int line;
};

struct Site {
  Place place{};
  const char* operation = "";
  std::memory_order order{};

  bool operator==(const Site& other) const noexcept;
};

// Without the heap: Relacy counts what is allocated while it runs.
class Orders {
 public:
  // Notes the site, and returns the order to use there.
  rl::memory_order at(const Site& site);
  std::span<const Site> sites() const noexcept { return std::span(sites_).first(count_); }
  void forget() noexcept { count_ = 0; }

  void weaken(const Site& site, std::memory_order to) noexcept { weakened_ = site, to_ = to; }
  void weaken_none() noexcept { weakened_ = {}; }

 private:
  std::array<Site, 64> sites_{};
  std::size_t count_ = 0;
  Site weakened_{};
  std::memory_order to_{};
};
Orders& orders() noexcept;

// As std::atomic_ref, of a number of Relacy's.
template <typename T>
class ModelRef {
 public:
  explicit ModelRef(rl::atomic<T>& word) : word_(word) {}

  T load(std::memory_order order, const char* file = __builtin_FILE(), const char* function = __builtin_FUNCTION(),
         int line = __builtin_LINE()) const {
    const Place place{file, function, line};
    return word_.load(orders().at({place, "load", order}), info(place));
  }
  void store(T value, std::memory_order order, const char* file = __builtin_FILE(),
             const char* function = __builtin_FUNCTION(), int line = __builtin_LINE()) const {
    const Place place{file, function, line};
    word_.store(value, orders().at({place, "store", order}), info(place));
  }
  T exchange(T value, std::memory_order order, const char* file = __builtin_FILE(),
             const char* function = __builtin_FUNCTION(), int line = __builtin_LINE()) const {
    const Place place{file, function, line};
    return word_.exchange(value, orders().at({place, "exchange", order}), info(place));
  }
  bool compare_exchange_strong(T& expected, T value, std::memory_order order, std::memory_order failed,
                               const char* file = __builtin_FILE(), const char* function = __builtin_FUNCTION(),
                               int line = __builtin_LINE()) const {
    const Place place{file, function, line};
    const rl::memory_order done = orders().at({place, "compare_exchange", order});
    return word_.compare_exchange(rl::bool_t<false>(), expected, value, done,
                                  orders().at({place, "compare_exchange that fails", failed}), info(place));
  }

 private:
  static rl::debug_info info(const Place& place) {
    return {place.function, place.file, static_cast<unsigned>(place.line)};
  }
  rl::atomic<T>& word_;
};

// What one thread at a time may touch: Relacy looks whether the others' accesses are over, or only seem so.
template <typename T>
class Cell {
 public:
  Cell() = default;  // to read it before it is written is an error too
  Cell(T value) : value_(value) {}
  Cell(const Cell& other) : value_(other.get()) {}
  Cell& operator=(const Cell& other) {
    value_(RL_INFO).store(other.get());
    return *this;
  }
  Cell& operator=(T value) {
    value_(RL_INFO).store(value);
    return *this;
  }
  operator T() const { return get(); }
  T get() const { return value_(RL_INFO).load(); }

 private:
  rl::var<T> value_;
};

// What a thread does that waits for another.
inline void look_again() { rl::ctx().yield(1, RL_INFO); }

struct ModelMemory {
  template <typename T>
  class Word {
   public:
    explicit Word(T first = T{}) : value_(first) {}

   private:
    friend struct ModelMemory;
    mutable rl::atomic<T> value_;
  };

  template <typename T>
  static ModelRef<T> at(const Word<T>& word) {
    return ModelRef<T>(word.value_);
  }

  template <typename T>
  static constexpr bool can_cross = true;  // Cells copy themselves
};

}  // namespace kadans::interleavings
