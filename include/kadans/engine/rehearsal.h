// A rehearsal of the tick. Between two ticks a CPU works for others, and when it comes back the tick's code and memory
// are no longer in its caches: a tick of one microsecond takes five. The control thread, which waits for the last
// stretch anyway, therefore goes through the tick beforehand: the same functions, on copies of what they would change.
//
// Nothing that counts is changed, no plant is read or written, no command taken, nothing published: a run with
// rehearsals and one without compute the same (tests/engine/rehearsal_test.cpp). No allocation, no system call.
#pragma once

#include "kadans/estimate/estimator.h"
#include "kadans/safety/safety.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/status.h"

namespace kadans {

// What a rehearsal works on. Control thread.
struct Rehearsal {
  Rehearsal(double period_s, const Estimator& estimated, const Safety& guarded, const RobotModel& model)
      : dt_s(period_s), estimator(estimated), safety(guarded.settings(), model) {}

  // The last sample once more, as if it were a new one.
  void sample(const SensorFrame& last) noexcept {
    sensors = last;
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
