#include "engine_states.h"

#include <utility>

namespace kadans {

EngineStates::EngineStates(ControlEngine& engine, std::vector<const DownStorage*> down, std::uint64_t every_ticks)
    : engine_(engine), down_(std::move(down)), every_ticks_(every_ticks), found_(down_.size()) {
  StateBytes measuring(StateBytes::Levels::low);
  engine_.pass_state(measuring);
  bytes_.resize(measuring.size());
}

void EngineStates::save(std::uint64_t tick) noexcept {
  if (waits_.load(std::memory_order_acquire)) return;
  StateBytes saving = StateBytes::saving(bytes_, StateBytes::Levels::low);
  engine_.pass_state(saving);
  for (std::size_t i = 0; i < down_.size(); ++i) found_[i] = down_[i]->taken();
  size_ = saving.size();
  tick_ = tick;
  if (saving.ok()) waits_.store(true, std::memory_order_release);
}

bool EngineStates::take(Saved& saved) const noexcept {
  if (!waits_.load(std::memory_order_acquire)) return false;
  saved = {tick_, found_, std::span(bytes_).first(size_)};
  return true;
}

}  // namespace kadans
