// A rehearsal of the tick. Between two ticks the CPU works for others, and afterwards the tick's code and memory are no
// longer in its caches: a tick of one microsecond takes five. Therefore, in the last part of its wait, the control
// thread goes through the tick beforehand: it calls the same functions, on copies of what they would change.
//
// A rehearsal changes nothing that counts. It reads and writes no plant, takes no command and publishes nothing. So a
// run with rehearsals computes the same as a run without (tests/engine/rehearsal_test.cpp). No allocation, no system
// call.
#pragma once

#include "estimate/estimator.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/status.h"
#include "safety/safety.h"

namespace kadans {

// What a rehearsal works on. Control thread.
struct Rehearsal {
  Rehearsal(double period_s, const Estimator& estimated, const Safety& guarded, const RobotModel& model)
      : dt_s(period_s), estimator(estimated), safety(guarded.settings(), model) {}

  // The last sample once more, as if it were a new one.
  void sample(const SensorFrame& last) noexcept {
    copy_used(last, sensors);
    for (std::uint32_t i = 0; i < last.joint_count; ++i) ++sensors.joints[i].sequence;
    for (std::uint32_t i = 0; i < last.foot_count; ++i) ++sensors.feet[i].sequence;
    ++sensors.imu.sequence;
  }

  double dt_s;
  SensorFrame sensors;
  Estimator estimator;
  Safety safety;
  Snapshot snapshot;
  ActuationFrame actuation;
};

}  // namespace kadans
