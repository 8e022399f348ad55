#include "leaving.h"

#include "kadans/signal/input_error.h"

namespace kadans {

void Leaving::beside_tick(std::int64_t time_ns) {
  if (!asked_.load(std::memory_order_relaxed)) return;
  if (step_ == Step::play) {
    try {
      host_.order({.kind = PlayOrder::Kind::stop});  // carried out in the tick that follows
    } catch (const InputError&) {                    // the process of the behaviors is down
    }
    step_ = Step::leave;
    return;
  }
  if (step_ == Step::leave) posture_.failed(time_ns, ~ObjectMask{0});
  step_ = Step::move;
  if (posture_.due(time_ns)) {
    const auto snapshot = exchange_.snapshot.read(0);
    posture_.move(*snapshot, behaviors_.sender(), 0);
  }
}

}  // namespace kadans
