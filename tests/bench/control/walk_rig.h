// TULip's walking object at work: it steps at 0.3 m/s as the forces of its feet tell it, and moves nothing.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/assembly/robot.h"

namespace kadans::bench {

class WalkRig {
 public:
  WalkRig() : robot_(read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json")), system_(make_control_system(robot_)) {
    for (std::size_t i = 0; i < system_->catalog.objects.size(); ++i) {
      if (system_->catalog.objects[i].name == "walk") walk_ = system_->objects[i].get();
    }
    snapshot_.joints.count = written_.joint_count = static_cast<std::uint32_t>(robot_.config.model.joints.size());
    for (const PoseInfo& pose : system_->catalog.poses) {
      if (pose.name != "set_out") continue;
      for (const auto& [joint, position_rad] : pose.position_rad)
        snapshot_.joints.joints[joint].position_rad = position_rad;
    }
    snapshot_.status.foot_count = 2;
    row_.resize(system_->catalog.signals.size());
    walk_->start(input());
    lead("forward_m_s", 0.3);
    lead("go", 1);
  }

  // What the feet feel in the next tick: the one that stands bears the robot, and the other one lands when it is meant
  // to.
  void feel() {
    system_->catalog.signals.gather(row_);
    const std::size_t stance = signal("stance") > 0.5 ? 1 : 0;
    snapshot_.status.feet[stance].force_N = 140;
    snapshot_.status.feet[1 - stance].force_N = signal("time_s") > signal("step_s") ? 30 : 0;
  }
  double steps() const { return signal("steps"); }  // as of the last feel()
  void step() {
    walk_->step(input(), written_);
    snapshot_.time_ns += 1'000'000;
  }

 private:
  ControlInput input() const { return {snapshot_.joints, snapshot_.status, written_, snapshot_.time_ns, 0.001}; }
  double signal(const std::string& name) const { return row_[*system_->catalog.signals.find("control.walk." + name)]; }
  void lead(std::string_view name, double value) {
    const auto id = system_->catalog.setpoints.find("walk." + std::string(name));
    walk_->follow(system_->catalog.setpoints[*id].channel, {.value = value});
  }

  Robot robot_;
  std::unique_ptr<ControlSystem> system_;
  ControlObject* walk_ = nullptr;
  Snapshot snapshot_;
  ActuationFrame written_;
  std::vector<double> row_;
};

}  // namespace kadans::bench
