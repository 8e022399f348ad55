#include "kadans/safety/emergency_stop.h"

namespace kadans {

void EmergencyStop::ask(std::string_view who) noexcept {
  Words none = Words::none;
  if (words_.compare_exchange_strong(none, Words::being_written, std::memory_order_acquire,
                                     std::memory_order_relaxed)) {
    who_ = fault_words(who);
    words_.store(Words::there, std::memory_order_release);
  }
  asked_.store(true, std::memory_order_release);  // it counts, be the words there or not
}

bool EmergencyStop::take(FaultWords& who) noexcept {
  if (!asked_.load(std::memory_order_relaxed) || !asked_.exchange(false, std::memory_order_acquire)) return false;
  who = {};
  if (words_.load(std::memory_order_acquire) == Words::there) {
    who = who_;
    words_.store(Words::none, std::memory_order_release);
  }
  return true;
}

}  // namespace kadans
