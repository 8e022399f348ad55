#include "behavior_engine.h"

namespace kadans {

void BehaviorEngine::prepare() noexcept {
  if (host_ == nullptr) return;
  const auto snapshot = exchange_.snapshot.read(0);
  host_->prepare(*snapshot);
}

void BehaviorEngine::tick(std::int64_t time_ns) {
  const auto snapshot = exchange_.snapshot.read(0);
  sets_.update(tick_, *snapshot);
  if (host_ != nullptr) host_->tick(*snapshot, commands_);
  exchange_.heartbeat.publish(time_ns);
  ++tick_;
}

}  // namespace kadans
