// The truth of a model, for the record: on the control thread, whose row it becomes part of, after the tick.
#pragma once

#include "kadans/engine/control_engine.h"
#include "kadans/realtime/engine_tasks.h"
#include "kadans/scenario/truth_signals.h"

namespace kadans {

class TruthTask final : public BesideTick {
 public:
  // Both must outlive it.
  TruthTask(TruthSignals& truth, const ControlEngine& control) noexcept : truth_(truth), control_(control) {}
  void beside_tick(std::int64_t time_ns) override;

 private:
  TruthSignals& truth_;
  const ControlEngine& control_;
};

}  // namespace kadans
