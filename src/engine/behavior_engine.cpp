#include "behavior_engine.h"

namespace kadans {

void BehaviorEngine::prepare() noexcept {
  if (host_ == nullptr) return;
  const auto snapshot = exchange_.snapshot.read(0);
  host_->prepare(*snapshot);
}

// What low levels gave stays as it is in this tick.
void BehaviorEngine::pin(std::int64_t seen_ns) {
  for (std::uint32_t i = 0; i < up_.size(); ++i) {
    if (up_[i]->pin(seen_ns)) inputs_->found_newer(i, up_[i]->pinned());
  }
}

void BehaviorEngine::tick(std::int64_t time_ns) {
  const auto snapshot = exchange_.snapshot.read(0);
  if (host_ != nullptr) host_->before_tick(*snapshot);
  if (inputs_ != nullptr) {
    inputs_->tick_begins(*snapshot, time_ns);
    pin(snapshot->time_ns);
    commands_.in_tick(true);
  }
  sets_.update(tick_, *snapshot);
  if (host_ != nullptr) host_->tick(*snapshot, commands_);
  if (inputs_ != nullptr) {
    for (UpStorage* storage : up_) storage->unpin();
    commands_.in_tick(false);
    inputs_->tick_ends();
  }
  exchange_.heartbeat.publish(time_ns);
  ++tick_;
}

}  // namespace kadans
