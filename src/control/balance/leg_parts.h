// What part each joint has in a leg, from the kinematics: by the axis about which it turns with all joints at 0, and by
// its place between base and foot. So names do not matter.
//
//   about z  hip_yaw     the first; what else turns about z has no part
//   about x  hip_roll    the first; ankle_roll: the last, below a knee
//   about y  hip_pitch   the first; ankle_pitch: the last; knee: what lies between
//
// A joint about an axis aslant, and a slider, has no part. Of a joint in no leg that turns about y it is `swing`, as of
// a shoulder.
//
// Before the loop; allocates and throws.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kadans/model/robot_model.h"

namespace kadans {

enum class LegPart : std::uint8_t { none, hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll, swing };

struct JointPart {
  LegPart part = LegPart::none;
  double sign = 1;      // -1: it turns the other way, about -x, -y or -z
  std::size_t leg = 0;  // the foot's place among those given
};

// One a joint of the model. `feet`: the links at the legs' ends.
std::vector<JointPart> leg_parts(const RobotModel& model, std::span<const std::size_t> feet);

}  // namespace kadans
