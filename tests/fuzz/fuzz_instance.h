// A robot of two motors that is seen from outside, all on one thread and on virtual time: what serves clients is the
// target's. Its project lies in a folder that all instances of a program have one after the other.
#pragma once

#include <string>

#include "engine/bench.h"
#include "fuzz_folder.h"
#include "kadans/remote/behavior_side.h"
#include "kadans/remote/control_side.h"
#include "kadans/remote/live_hub.h"
#include "kadans/remote/record_side.h"
#include "kadans/script/script_host.h"
#include "kadans/telemetry/event_log.h"

namespace kadans::fuzz {

// As it was, for every instance. Holds a behavior "nod", and one that never ends, "wait".
class FuzzProject {
 public:
  static const FuzzProject& fresh();
  const std::filesystem::path& root() const noexcept { return folder_.path(); }

 private:
  FuzzProject();
  FuzzFolder folder_;
};

class FuzzInstance {
  const std::filesystem::path& root_ = FuzzProject::fresh().root();
  EngineSettings fast_{.behavior_period_s = 0.001};

 public:
  bench::Robot robot;
  RecordLog record_log;
  EchoLog echo{&record_log};
  ScriptHost host;
  Instance instance;
  ControlSide control_side{instance};
  RecordSide record_side{instance, control_side, record_log, {}};
  BehaviorSide behavior_side{{instance, &host, nullptr, robot.behaviors, *robot.exchange, echo, echo}};
  Lockstep lockstep{fast_, robot.plant, robot.control, robot.behaviors};

  FuzzInstance();
  LiveHub::Parts hub_parts(LivePace* pace);  // opens a port
  // A tick of everything.
  void step();
};

}  // namespace kadans::fuzz
