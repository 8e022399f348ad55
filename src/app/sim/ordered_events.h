// Events that orders brought into a simulation (kadans ctl emit, the page, ROS 2). Nothing else that is ordered comes
// back in a replay; these do: the record has each with its time and its data, and a run that repeats it gets them as
// events of its scenario. A checkpoint holds those before it as a fact of the run, "events".
#pragma once

#include <string>

#include "config/scenario/scenario_config.h"
#include "engine/behavior_log.h"
#include "telemetry/record/run_inputs.h"

namespace kadans {

// Keeps them while a run goes.
class OrderedEvents final : public LineSink {
 public:
  void tell(const Line& /*line*/) override {}
  void tell_emitted(const EmittedEvent& event) override;

  const std::string& fact() const noexcept { return fact_; }  // "": there were none

 private:
  std::string fact_;
};

// Adds the events of the fact, and those in the messages of `record` ("": none is read), to the events of the scenario.
// Throws InputError when they are damaged.
void add_ordered_events(const RunInputs& inputs, const std::string& record, ScenarioConfig& scenario);

}  // namespace kadans
