// A robot for tests: what those of behaviors and those of decisions have in common.
#pragma once

#include <string>

#include "app/assembly/assembly.h"
#include "script/test/behavior_test.h"
#include "set_sensors.h"

namespace kadans {

class RobotStage : public TestStage {
 public:
  void advance(double seconds) override {
    due_s_ += seconds;
    Lockstep& lockstep = assembly_.parts().lockstep;
    while (static_cast<double>(lockstep.time_ns()) < due_s_ * 1e9 - 1) {
      lockstep.step();
      stepped(lockstep.time_ns());
    }
    look();
  }
  const Snapshot& snapshot() const override { return seen_; }
  const Catalog& catalog() const override { return assembly_.catalog(); }
  std::string said() const override {
    std::string all;
    for (const LogLine& line : log_.lines()) all += line.text + "\n";
    return all;
  }
  std::string went() override {
    std::string all = log_.transitions().empty() ? behavior().state() : log_.transitions().front().from;
    for (const Transition& transition : log_.transitions()) all += " " + transition.to;
    return all;
  }
  bool set_sensor(const std::string& name, double value) override {
    const bool known = sensors_.set(name, value);
    sensors_.change(seen_);
    return known;
  }

 protected:
  explicit RobotStage(ScenarioConfig scenario)
      : scenario_(std::move(scenario)), assembly_(scenario_, scenario_.seed, log_), sensors_(assembly_.catalog()) {}

  virtual void stepped(std::int64_t /*time_ns*/) {}  // after each tick
  void look() {
    seen_ = assembly_.control().state();
    sensors_.change(seen_);
  }

  ScenarioConfig scenario_;
  RunLog log_;
  Assembly assembly_;
  SetSensors sensors_;
  Snapshot seen_;

 private:
  double due_s_ = 0;
};

}  // namespace kadans
