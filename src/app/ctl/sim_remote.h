// Makes a simulation reachable from outside. The parts of an instance (remote/instance/instance.h) that are threads in
// a live run are executed in turn by the simulation's one thread, between its ticks.
#pragma once

#include <optional>

#include "app/assembly.h"
#include "app/live/live_service.h"
#include "app/ros2/ros2_service.h"
#include "ctl_service.h"
#include "remote/instance/behavior_side.h"
#include "remote/instance/control_side.h"
#include "remote/instance/record_side.h"
#include "scenario/disturb/disturbances.h"
#include "scenario/run.h"

namespace kadans {

// Passes events and messages to the instance, once there is one, and to `next`.
class InstanceLog final : public BehaviorLog {
 public:
  explicit InstanceLog(BehaviorLog* next) noexcept : next_(next) {}
  void tell(Instance* instance) noexcept { instance_ = instance; }
  void transition(const Transition& transition) override;
  void message(std::int64_t time_ns, Severity severity, const std::string& behavior, const std::string& text) override;

 private:
  BehaviorLog* next_;
  Instance* instance_ = nullptr;
  Event event_;
};

class SimRemote final : public RunObserver {
 public:
  struct Logs {
    InstanceLog& told;
    EchoLog& echo;
    RecordLog& record;
    BehaviorLog& all;
  };
  struct Places {
    CtlServiceOptions ctl;
    LiveServiceOptions live;
    Ros2Options ros2;
  };
  // All references must outlive this object. It replaces the assembly's record sink. `plan` is for records that clients
  // order.
  SimRemote(const Places& places, const ScenarioConfig& scenario, Assembly& assembly, RecordPlan plan,
            const Logs& logs);
  ~SimRemote() override;
  SimRemote(const SimRemote&) = delete;
  SimRemote& operator=(const SimRemote&) = delete;

  // Call before the first tick. `own` is the simulation's own record, or nullptr.
  void begin(RecordSink* own, const std::string& own_file);

  // Call after the last tick: closes a record that a client has ordered. Returns "", or why it is not complete.
  std::string end_record();

  LivePace& pace() noexcept { return pace_; }
  void tick(double time_s, std::span<const double> row) override;
  void fault(const Fault& fault) override { instance_.tell(fault); }
  void between_ticks(const RunMark& mark) override;

 private:
  void push(const RunMark& mark);

  RunParts parts_;
  const RobotModel& model_;
  BehaviorLog& log_;
  InstanceLog& told_;
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
