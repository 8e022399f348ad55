// A robot of two motors that is seen from outside, all on one thread and on virtual time: what serves clients is the
// target's. Its project lies in a folder that all instances of a program have one after the other.
//
// To make an instance takes longer than most inputs: a few that change it have it one after the other. Those before lie
// in the folder that is named when the program begins, so that what needs them too is seen again by
// `fuzz_TARGET FOLDER/* INPUT`.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "engine/bench.h"
#include "remote/instance/behavior_side.h"
#include "remote/instance/control_side.h"
#include "remote/instance/record_side.h"
#include "remote/page/live_hub.h"
#include "script/host/script_host.h"
#include "telemetry/record/event_log.h"
#include "temporary_folder.h"

namespace kadans::fuzz {

// As it was, for every instance. Holds a behavior "nod", and one that never ends, "wait".
class FuzzProject {
 public:
  static const FuzzProject& fresh();
  // An input that an instance had, by its number from 1.
  static void keep(std::string_view input, int number);
  const std::filesystem::path& root() const noexcept { return folder_.path(); }

 private:
  FuzzProject();
  static const FuzzProject& only();
  test::TemporaryFolder folder_;
};

class FuzzInstance {
  const std::filesystem::path& root_ = FuzzProject::fresh().root();
  EngineSettings fast_{.behavior_period_s = 0.001};

 public:
  bench::Robot robot;
  LineEcho echo;
  BehaviorLog log{&echo};
  ScriptHost host;
  Instance instance;
  ControlSide control_side{instance};
  RecordSide record_side{instance, control_side, {}};
  BehaviorSide behavior_side{{instance, &host, nullptr, robot.behaviors, *robot.exchange, echo, log}};
  Lockstep lockstep{fast_, robot.plant, robot.control, robot.behaviors};

  FuzzInstance();
  LiveHub::Parts hub_parts(LivePace* pace);  // opens a port
  // A tick of everything.
  void step();
  // The robot runs and nothing is recorded, as in the beginning.
  bool runs();
};

// Of a Bench that has an `instance`.
template <typename Bench>
class KeptBench {
 public:
  Bench& get() {
    if (!bench_) bench_ = std::make_unique<Bench>();
    return *bench_;
  }
  void changed_by(std::string_view input) {
    for (int i = 0; i < 4; ++i) bench_->instance.step();  // what was asked for is done before the next comes
    ++changes_;
    if (changes_ < changes_max && bench_->instance.runs()) return FuzzProject::keep(input, changes_);
    bench_.reset();
    changes_ = 0;
  }

 private:
  static constexpr int changes_max = 16;
  std::unique_ptr<Bench> bench_;
  int changes_ = 0;
};

}  // namespace kadans::fuzz
