// Ends a run whose model diverges: long before its numbers are lost, and with the likely reason.
//
// A joint diverges beyond 1000 rad/s (100 m/s for a slider), or beyond ten times its own speed limit where that is
// more; the base beyond 1000 rad/s or 100 m/s, which is more than half a kilometre of free fall. No robot's joint gets
// there by itself: what does is a gain that is too high for the loop's delay, a mass that is too small for the step, or
// a world that pushes what it cannot move.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "kadans/model/robot_model.h"
#include "plant/bullet/joint/drives.h"

namespace kadans::bullet {

class Divergence {
 public:
  Divergence(const RobotModel& model, const PlantSettings& settings);

  // After a step, which ended at time_ns. Throws std::runtime_error with joint or base, time and reason when the state
  // diverges or is not finite. Allocates nothing else.
  void look(const btMultiBody& body, const Drives& drives, double dt_s, std::int64_t time_ns);

 private:
  struct Watched {
    std::string name;
    bool slides;
    double speed_max;        // rad/s or m/s
    double inertia;          // at the start, with what it carries and its rotor: kg m2 or kg
    bool pushes = false;     // the sign of its drive's torque in the last step
    double turned_over = 0;  // in which share of the last steps that sign changed, smoothed
  };

  [[noreturn]] void tell(const Drives& drives, const std::string& what, double dt_s, std::int64_t time_ns,
                         int joint) const;

  std::vector<Watched> joints_;
};

}  // namespace kadans::bullet
