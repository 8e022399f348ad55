// One motion of one joint on the bench, by effort, and what it saw of all joints meanwhile. A motion begins anew when
// the key was let go.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kadans/signal/capacity.h"

namespace kadans {

// All joints in this tick.
struct BenchSight {
  double time_s = 0, dt_s = 0;                                                   // since the session began; of a tick
  std::array<double, max_joints> position_rad{}, velocity_rad_s{}, effort_Nm{};  // effort: as the drives tell it
  std::array<double, max_joints> since_s{};  // from the reading before to this one; 0: it is not new
};

class Push {
 public:
  virtual ~Push() = default;

  virtual void begin(const BenchSight& sight) { (void)sight; }
  // The effort that its drive is asked for in this tick.
  virtual double step(const BenchSight& sight) = 0;
  virtual bool complete() const { return false; }
  // Why the joint must be let go at once; "": it need not.
  virtual std::string_view aborted() const { return ""; }
};

}  // namespace kadans
