// Updates the truth signals of a model for the record. It runs on the control thread after the tick, because its
// signals are part of the control thread's row.
#pragma once

#include "engine/tick/control_engine.h"
#include "realtime/engine_tasks.h"
#include "scenario/judge/truth_signals.h"

namespace kadans {

class TruthTask final : public BesideTick {
 public:
  // Both references must outlive this object.
  TruthTask(TruthSignals& truth, const ControlEngine& control) noexcept : truth_(truth), control_(control) {}
  void beside_tick(std::int64_t time_ns) override;

 private:
  TruthSignals& truth_;
  const ControlEngine& control_;
};

}  // namespace kadans
