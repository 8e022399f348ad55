// The last word to a plant, whichever thread hangs.
//
// The control engine reaches its plant through this object. Between two of its calls, another thread can say the last
// word: one more actuation, and from then on the engine's calls do nothing. So a control thread that hangs in an
// algorithm, or a starved one, does not keep the drives from being switched off, and cannot drive them again when it
// goes on. Only when the thread hangs in the plant itself is nothing said: then the drives' own watchdog must act.
//
// Threads: read and write the control thread, which never waits; say any other.
#pragma once

#include <atomic>
#include <cstdint>

#include "kadans/plant/plant.h"

namespace kadans {

class LastWord final : public Plant {
 public:
  explicit LastWord(Plant& plant) : plant_(plant) {}  // keeps a reference

  void read(SensorFrame& sensors) noexcept override {
    if (!enter()) return;
    plant_.read(sensors);
    turn_.store(Turn::free, std::memory_order_release);
  }
  void write(const ActuationFrame& actuation) noexcept override {
    if (!enter()) return;
    plant_.write(actuation);
    turn_.store(Turn::free, std::memory_order_release);
  }

  // Waits at most patience_ns for the control thread to leave the plant. False: it did not, and nothing was written. A
  // second word changes nothing.
  [[nodiscard]] bool say(const ActuationFrame& word, std::int64_t patience_ns) noexcept;

 private:
  enum class Turn : std::uint8_t { free, control, over };
  static_assert(std::atomic<Turn>::is_always_lock_free);

  bool enter() noexcept {
    Turn turn = Turn::free;
    return turn_.compare_exchange_strong(turn, Turn::control, std::memory_order_acquire, std::memory_order_relaxed);
  }

  Plant& plant_;
  std::atomic<Turn> turn_{Turn::free};
};

}  // namespace kadans
