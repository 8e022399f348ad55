#include "fault_state.h"

#include <thread>

#include "kadans/control/state_bytes.h"
#include "signal/number_text.h"

namespace kadans {
FaultState::FaultState(ControlSets& sets, const Catalog& catalog)
    : sets_(sets), catalog_(catalog), bytes_(sets.size()) {
  for (std::uint32_t i = 0; i < bytes_.size(); ++i) {
    StateBytes measuring(StateBytes::Levels::low);
    sets_.object(i).pass_state(measuring);
    bytes_[i].resize(measuring.size());
  }
}

void FaultState::keep(std::uint64_t tick) noexcept {
  if (busy_.exchange(true, std::memory_order_acquire)) return;
  tick_ = tick;
  known_ = true;
  for (std::uint32_t i = 0; i < bytes_.size(); ++i) {
    StateBytes saving = StateBytes::saving(bytes_[i], StateBytes::Levels::low);
    sets_.object(i).pass_state(saving);
  }
  busy_.store(false, std::memory_order_release);
}

TextMap FaultState::facts() const {
  while (busy_.exchange(true, std::memory_order_acquire)) std::this_thread::yield();
  const bool known = known_;
  const std::uint64_t tick = tick_;
  const std::vector<std::vector<std::byte>> bytes = known ? bytes_ : std::vector<std::vector<std::byte>>{};
  busy_.store(false, std::memory_order_release);
  TextMap facts;
  if (known) facts["tick"] = std::to_string(tick);
  for (std::size_t i = 0; i < bytes.size(); ++i) facts["object " + catalog_.objects[i].name] = hexadecimal(bytes[i]);
  return facts;
}

}  // namespace kadans
