// The state of a control object as bytes: all that changes from tick to tick. An object that gets it back, or another
// one of the same type with the same setup and parameters, continues bit for bit as the first one did. Parameters, and
// what follows from the setup, are no state.
//
// An object has one function for both ways, so that saving and restoring cannot differ:
//
//   void pass_state(StateBytes& bytes) noexcept override {
//     for (Part& part : parts_) bytes(part.state, part.reference);  // what the control thread owns
//     bytes.newest(data_);                                          // what the high level sent to it
//     bytes.high_level(last_update_ns_);                            // what the behavior thread owns
//   }
//
// A member with a pass_state of its own is asked for it. Any other is a number, an enumeration, a std::array or an
// aggregate, and passes by its members, so that padding is never among the bytes. They are those of this build and hold
// no pointer. How many there are follows from the setup: measure once, before the loop. Nothing here allocates, locks
// or throws.
//
// By the same function the state is hashed. Two objects with the same hash go on alike; so a state can be compared
// where it is not held. Bytes of a flight record come from outside: must() checks what could do harm.
//
// Threads: the control thread, between ticks. With Levels::both the behavior thread must stand still, too.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

#include "kadans/exchange/latest.h"
#include "kadans/signal/members.h"
#include "kadans/signal/state_hash.h"

namespace kadans {

class StateBytes {
 public:
  enum class Levels : bool { low, both };

  explicit StateBytes(Levels levels = Levels::both) noexcept : levels_(levels) {}  // measures: size() says how many
  // `hash` must outlive this.
  static StateBytes hashing(StateHash& hash, Levels levels = Levels::both) noexcept {
    StateBytes made(levels);
    made.hash_ = &hash;
    return made;
  }
  static StateBytes saving(std::span<std::byte> bytes, Levels levels = Levels::both) noexcept {
    StateBytes made(levels);
    made.to_ = bytes.data();
    made.room_ = bytes.size();
    return made;
  }
  static StateBytes restoring(std::span<const std::byte> bytes, Levels levels = Levels::both) noexcept {
    StateBytes made(levels);
    made.from_ = bytes.data();
    made.room_ = bytes.size();
    return made;
  }

  template <typename... T>
  void operator()(T&... state) noexcept {
    (pass(state), ...);
  }
  template <typename... T>
  void high_level(T&... state) noexcept {
    if (levels_ == Levels::both) (pass(state), ...);
  }
  // What the low level finds in a storage of the object.
  template <typename Storage>
  void newest(Storage& latest) noexcept {
    auto value = latest.newest();
    pass(value);
    if (restores() && ok()) latest.replace(value);
  }

  // Bytes may come from a file. What reads memory by them, an index or a count, must be right, and so says the function
  // behind it: bytes(phase_); bytes.must(phase_ < phases). Otherwise the state is refused.
  void must(bool holds) noexcept { refused_ = refused_ || (restores() && !holds); }

  bool restores() const noexcept { return from_ != nullptr; }
  bool measures() const noexcept { return to_ == nullptr && from_ == nullptr && hash_ == nullptr; }
  std::size_t size() const noexcept { return size_; }
  // False: there were too few bytes, or they are refused. Then not all is saved or restored, and what got them must not
  // be used.
  bool ok() const noexcept { return !refused_ && ((to_ == nullptr && from_ == nullptr) || size_ <= room_); }

 private:
  template <typename T>
  void pass(T& state) noexcept {
    if constexpr (requires { state.pass_state(*this); }) {
      state.pass_state(*this);
    } else if constexpr (requires { typename T::Plain; }) {
      pass(static_cast<typename T::Plain&>(state));  // without the number of hand_over.h
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>, "state is copied, and by its value");
      if constexpr (std::is_arithmetic_v<T>) {
        number(state);
      } else if constexpr (std::is_enum_v<T>) {
        auto value = static_cast<std::underlying_type_t<T>>(state);
        number(value);
        state = static_cast<T>(value);
      } else if constexpr (requires { state.begin(); }) {
        for (auto& one : state) pass(one);
      } else {
        with_members(state, [this](auto&... members) { (this->pass(members), ...); });
      }
    }
  }

  template <typename T>
  void number(T& value) noexcept {
    const std::size_t at = size_;
    size_ += sizeof value;
    if (hash_ != nullptr) hash_->add(value);
    if (size_ > room_) return;
    if (to_ != nullptr) std::memcpy(to_ + at, &value, sizeof value);
    if (from_ != nullptr) take_members(value, from_ + at);
  }

  Levels levels_;
  std::byte* to_ = nullptr;
  const std::byte* from_ = nullptr;
  StateHash* hash_ = nullptr;
  std::size_t room_ = 0, size_ = 0;
  bool refused_ = false;
};

}  // namespace kadans
