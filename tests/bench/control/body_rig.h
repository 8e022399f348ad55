// TULip's whole-body object at work: it sinks, shifts its weight and leans, each joint where it is led.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "app/assembly/robot.h"

namespace kadans::bench {

// A robot that stands as its pose says, and is where it is led.
class BodyRig {
 public:
  BodyRig()
      : robot_(read_robot(KADANS_SOURCE_DIR "/config/reaching/robot.json")), system_(make_control_system(robot_)) {
    for (std::size_t i = 0; i < system_->catalog.objects.size(); ++i) {
      if (system_->catalog.objects[i].name == "body") object_ = system_->objects[i].get();
    }
    snapshot_.joints.count = written_.joint_count = static_cast<std::uint32_t>(robot_.config.model.joints.size());
    for (const PoseInfo& pose : system_->catalog.poses) {
      if (pose.name != "stand") continue;
      for (const auto& [joint, position_rad] : pose.position_rad)
        snapshot_.joints.joints[joint].position_rad = position_rad;
    }
    row_.resize(system_->catalog.signals.size());
    object_->start({snapshot_.joints, snapshot_.status, written_, 0, 0.001});
    tick();
    for (const char* name : {"com_z_m", "com_y_m", "trunk.pitch_rad"}) {
      const Setpoint& setpoint =
          system_->catalog.setpoints[*system_->catalog.setpoints.find(std::string("body.") + name)];
      SetpointState at;
      (void)object_->setpoint_state(setpoint.channel, at);
      led_[led_count_++] = {setpoint.channel, at.value};
    }
  }

  void tick() {
    low_level();
    high_level();
  }
  void low_level() {
    const double phase = 0.5 - 0.5 * std::cos(0.03 * ++ticks_);
    const std::array<double, 3> way{-0.06 * phase, 0.04 * phase, 0.35 * phase};
    for (std::size_t i = 0; i < led_count_; ++i) object_->follow(led_[i].channel, {.value = led_[i].value + way[i]});
    for (int i = 0; i < low_levels; ++i) {
      object_->step({snapshot_.joints, snapshot_.status, written_, snapshot_.time_ns, 0.001}, written_);
      snapshot_.time_ns += 1'000'000;
    }
  }
  void high_level() { object_->update(snapshot_); }
  void foresee() {
    const std::array goals{Foresight::Goal{led_[0].channel, led_[0].value - 0.06},
                           Foresight::Goal{led_[1].channel, led_[1].value + 0.04}};
    (void)object_->foresight()->miss({goals, 1.5}, snapshot_);
  }
  double signal(const std::string& name) {
    system_->catalog.signals.gather(row_);
    return row_[*system_->catalog.signals.find("control.body." + name)];
  }

 private:
  static constexpr int low_levels = 10;

  Robot robot_;
  std::unique_ptr<ControlSystem> system_;
  ControlObject* object_ = nullptr;
  Snapshot snapshot_;
  ActuationFrame written_;
  std::array<Foresight::Goal, 3> led_{};
  std::size_t led_count_ = 0;
  int ticks_ = 0;
  std::vector<double> row_;
};

}  // namespace kadans::bench
