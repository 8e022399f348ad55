// What whole-body control costs in the behavior thread: the high level of TULip's object while it sinks, shifts its
// weight and leans, each call by itself, and what it takes to say that a target can be reached.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "app/assembly.h"
#include "report.h"

namespace kadans::bench {
namespace {

constexpr int behavior_ticks = 600, low_levels = 10;
constexpr double behavior_period_us = 10'000;

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

  // Returns how long the high level took.
  double tick() {
    const double phase = 0.5 - 0.5 * std::cos(0.03 * ++ticks_);
    const std::array<double, 3> way{-0.06 * phase, 0.04 * phase, 0.35 * phase};
    for (std::size_t i = 0; i < led_count_; ++i) object_->follow(led_[i].channel, {.value = led_[i].value + way[i]});
    for (int i = 0; i < low_levels; ++i) {
      object_->step({snapshot_.joints, snapshot_.status, written_, snapshot_.time_ns, 0.001}, written_);
      snapshot_.time_ns += 1'000'000;
    }
    const double began = now_ns();
    object_->update(snapshot_);
    return 1e-3 * (now_ns() - began);
  }
  double foresee_us() {
    const std::array goals{Foresight::Goal{led_[0].channel, led_[0].value - 0.06},
                           Foresight::Goal{led_[1].channel, led_[1].value + 0.04}};
    Foresight& foresight = *object_->foresight();
    return 1e-3 * time_ns([&] { (void)foresight.miss({goals, 1.5}, snapshot_); }, 1, 100);
  }
  double signal(const std::string& name) {
    system_->catalog.signals.gather(row_);
    return row_[*system_->catalog.signals.find("control.body." + name)];
  }

 private:
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

}  // namespace

void bench_body(Report& report) {
  BodyRig rig;
  std::vector<double> each_us;
  double most = 0;
  for (int i = 0; i < behavior_ticks; ++i) {
    each_us.push_back(rig.tick());
    most = std::max(most, rig.signal("iterations"));
  }
  const double worst_us = *std::max_element(each_us.begin(), each_us.end()), median_us = median(each_us);
  report.add("body.median_us", "whole body, high level, median", median_us, "us");
  report.add("body.worst_us", "whole body, high level, worst", worst_us, "us");
  report.add("body.period_share", "whole body, median, share of the behavior period", median_us / behavior_period_us,
             "");
  report.add("body.iterations", "whole body, most iterations of its program", most, "");
  report.add("body.failures", "whole body, programs without a solution", rig.signal("failures"), "");
  report.add("body.foresee_us", "whole body, whether two targets can be reached", rig.foresee_us(), "us");
}

}  // namespace kadans::bench
