// What a control object that works joint by joint knows of each joint, and how it declares a joint's parameters,
// set-points and signals.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/pid.h"

namespace kadans {

struct JointAxis {
  std::size_t joint = 0;  // index in the model
  std::string name;
  double lower_rad = 0, upper_rad = 0;  // very wide for a continuous joint, but finite: a set-point needs a range
  double velocity_max_rad_s = 0;
  double effort_max_Nm = 0;
};

// One for each of the setup's joints. Throws std::invalid_argument for a passive joint.
std::vector<JointAxis> joint_axes(const ObjectSetup& setup);

// Declares one joint's parameters, set-points and signals; names get the joint's name in front.
class AxisTables {
 public:
  // The joint's set-points have the object's channels from first_channel on.
  AxisTables(Declaration& declaration, const JointAxis& axis, std::uint32_t first_channel)
      : declaration_(declaration), axis_(axis), first_channel_(first_channel) {}

  void tunable(const char* name, const char* unit, double min, double max, double initial, double* value,
               const char* doc);
  // `safe`: Setpoint::safe.
  void setpoint(const char* name, const char* unit, double min, double max, const char* doc, std::uint32_t which,
                bool own_motion = false, double safe = std::numeric_limits<double>::quiet_NaN());
  template <typename T>
  void signal(const char* name, const char* unit, const char* doc, const T* source) {
    declaration_.signal({axis_.name + "." + name, unit, doc}, source);
  }
  // The set-point position_rad, within the joint's limits.
  void position_setpoint(std::uint32_t which, bool own_motion = false);
  // Pid::Config as parameters, Pid::State as signals.
  void pid(Pid& pid);

  const JointAxis& axis() const noexcept { return axis_; }

 private:
  Declaration& declaration_;
  const JointAxis& axis_;
  std::uint32_t first_channel_;
};

}  // namespace kadans
