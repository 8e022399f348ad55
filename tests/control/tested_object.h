// What the benches here have in common: a control object's tables, read and set by name, and the frames that it
// computes from and into.
#pragma once

#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/control/catalog.h"
#include "kadans/control/control_object.h"

namespace kadans::test {

class TestedObject {
 public:
  static constexpr double dt_s = 0.001;

  void set(const std::string& parameter, double value) {
    const auto id = catalog.parameters.find("it." + parameter);
    REQUIRE_MESSAGE(id, parameter);
    REQUIRE(catalog.parameters.set(*id, value));
    object_->parameters_changed();
  }
  double signal(const std::string& name) {
    catalog.signals.gather(row_);
    const auto id = catalog.signals.find("control.it." + name);
    REQUIRE_MESSAGE(id, name);
    return row_[*id];
  }
  double effort_Nm(std::size_t joint) const { return computed.joints[joint].effort_Nm; }

  ControlInput input() const noexcept { return {joints, status, written, time_ns, dt_s}; }
  // The high level.
  void update() {
    snapshot.time_ns = time_ns;
    snapshot.joints = joints;
    object_->update(snapshot);
  }

  Catalog catalog;
  JointStates joints;
  RobotStatus status;
  ActuationFrame written, computed;
  Snapshot snapshot;
  std::int64_t time_ns = 0;
  bool high_level = true;

 protected:
  void declare(ControlObject& object, std::uint32_t joint_count) {
    object_ = &object;
    Declaration declaration("it", 0, catalog.parameters, catalog.setpoints, catalog.signals);
    object.declare(declaration);
    joints.count = written.joint_count = computed.joint_count = joint_count;
    row_.resize(catalog.signals.size());
  }
  // As the engines do it: what was computed in the last tick is written; the high level runs every tenth.
  void control_tick() {
    written = computed;
    object_->step(input(), computed);
    if (high_level && time_ns % 10'000'000 == 0) update();
  }

 private:
  ControlObject* object_ = nullptr;
  std::vector<double> row_;
};

}  // namespace kadans::test
