// Makes a simulation reachable from outside. The parts of an instance (remote/instance/instance.h) that are threads in
// a live run are executed in turn by the simulation's one thread, between its ticks.
#pragma once

#include <optional>

#include "app/assembly/assembly.h"
#include "app/services.h"
#include "remote/instance/behavior_side.h"
#include "remote/instance/control_side.h"
#include "remote/instance/record_side.h"
#include "scenario/disturb/disturbances.h"
#include "scenario/run.h"

namespace kadans {

class SimRemote final : public RunObserver {
 public:
  // All references must outlive this object; after it nothing is said. `echo` is a sink of `log`, the log of the
  // behaviors. This object replaces the assembly's record sink. `plan` is for records that clients
  // order.
  SimRemote(const ServiceOptions& places, Assembly& assembly, RecordPlan plan, BehaviorLog& log, LineEcho& echo);
  ~SimRemote() override;
  SimRemote(const SimRemote&) = delete;
  SimRemote& operator=(const SimRemote&) = delete;

  // Call before the first tick. `own` is the simulation's own record, or nullptr.
  void begin(RecordSink* own, const std::string& own_file);

  // Call after the last tick: closes a record that a client has ordered. Returns "", or why it is not complete.
  std::string end_record();

  LivePace& pace() noexcept { return pace_; }
  void fault(const Fault& fault) override {
    instance_.tell(fault);
    record_side_.tell(fault);
  }
  void between_ticks(const RunMark& mark) override;

 private:
  void push(const RunMark& mark);

  RunParts parts_;
  const RobotModel& model_;
  BehaviorLog& log_;
  Instance instance_;
  ControlSide control_side_;
  RecordSide record_side_;
  BehaviorSide behavior_side_;
  CtlService service_;
  LivePace pace_;
  LiveService live_;
  Ros2Service ros2_;
  std::vector<Pushes> pushes_;  // the newest pushes of clients
  std::uint32_t published_ = 0;
};

}  // namespace kadans
