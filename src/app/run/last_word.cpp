#include "last_word.h"

#include <ctime>

#include "engine/clock.h"

namespace kadans {

bool LastWord::say(const ActuationFrame& word, std::int64_t patience_ns) noexcept {
  constexpr timespec between_looks{0, 100'000};
  const WallClock clock;
  const std::int64_t until_ns = clock.now_ns() + patience_ns;
  Turn turn = Turn::free;
  while (!turn_.compare_exchange_strong(turn, Turn::over, std::memory_order_acquire, std::memory_order_acquire)) {
    if (turn == Turn::over) return true;
    if (clock.now_ns() >= until_ns) return false;
    nanosleep(&between_looks, nullptr);
    turn = Turn::free;
  }
  plant_.write(word);
  return true;
}

}  // namespace kadans
