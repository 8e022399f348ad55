// A robot of two motors whose engines and model run on threads of their own, on virtual time.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "engine/bench.h"
#include "realtime/engine_tasks.h"
#include "realtime/task_thread.h"
#include "realtime/virtual_time.h"

namespace kadans {

inline constexpr std::int64_t tick_ns = 1'000'000;

// Wakes its thread late, or not at all, when the test says so.
class DisturbedWait final : public Wait {
 public:
  explicit DisturbedWait(std::unique_ptr<Wait> wait) : wait_(std::move(wait)) {}

  std::int64_t now_ns() const noexcept override { return frozen() ? frozen_at_ns_ : wait_->now_ns(); }
  void end() noexcept override { wait_->end(); }
  void until(std::int64_t time_ns) noexcept override {
    if (frozen()) return;
    const bool late = time_ns >= late_from_ns && late_times > 0;
    if (late) --late_times;
    wait_->until(time_ns + (late ? late_by_ns : 0));
  }

  // Before the threads start.
  std::int64_t late_from_ns = 0, late_by_ns = 0;
  int late_times = 0;
  std::int64_t frozen_at_ns_ = INT64_MAX;

 private:
  bool frozen() const noexcept { return wait_->now_ns() >= frozen_at_ns_; }
  std::unique_ptr<Wait> wait_;
};

// What a test lets the behavior thread do before each of its ticks.
struct Script final : BesideTick {
  std::function<void(std::int64_t)> at;  // may throw
  void beside_tick(std::int64_t time_ns) override {
    if (at) at(time_ns);
  }
};

struct LiveRobot {
  EngineSettings settings;
  RobotModel model = bench::robot();
  IdealWorld plant{model, bench::plant_settings()};
  std::unique_ptr<PlantExchange> link = std::make_unique<PlantExchange>();
  LinkedPlant seen{*link, plant};
  Catalog catalog;
  Estimator estimator{model, {}, 0.001};
  Safety safety{bench::safety_settings(), model};
  std::vector<std::unique_ptr<ControlObject>> objects = bench::posture(catalog, model);
  ControlSets sets{catalog, std::move(objects)};
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  ControlEngine control{settings, seen, estimator, safety, sets, catalog, *exchange};
  BehaviorEngine behaviors{sets, *exchange, nullptr};

  VirtualTime time;
  std::unique_ptr<Wait> supervisor = time.make_wait();
  DisturbedWait control_wait{time.make_wait()}, plant_wait{time.make_wait()};
  std::unique_ptr<Wait> behavior_wait = time.make_wait();
  Script script;
  ControlTask control_task{control};
  BehaviorTask behavior_task{behaviors, &script};
  PlantTask plant_task{*link, plant, tick_ns};
  TaskThread control_thread{{.name = "control", .first_ns = tick_ns}, control_task, control_wait};
  TaskThread behavior_thread{
      {.name = "behaviors", .period_ns = 10 * tick_ns, .first_ns = 2 * tick_ns}, behavior_task, *behavior_wait};
  TaskThread plant_thread{{.name = "plant"}, plant_task, plant_wait};

  void start() {
    for (TaskThread* thread : threads()) thread->start();
  }
  // The supervisor waits; what the threads do until then is seen by the newest snapshot.
  Snapshot run_until(std::int64_t ms) {
    supervisor->until(ms * tick_ns + tick_ns / 2);
    return exchange->snapshot.newest(1);
  }
  void stop() {
    for (TaskThread* thread : threads()) thread->stop();
    supervisor->end();
    for (TaskThread* thread : threads()) thread->join();
  }
  std::array<TaskThread*, 3> threads() { return {&control_thread, &behavior_thread, &plant_thread}; }
};

}  // namespace kadans
