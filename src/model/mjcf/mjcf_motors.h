// What ties the joints of an MJCF together and moves them.
#pragma once

#include <map>
#include <string>

#include "mjcf_values.h"
#include "model/urdf/urdf_description.h"

namespace kadans {

struct MjcfMotorSettings {
  bool limits_by_range = true;               // autolimits
  std::map<std::string, double> joint_most;  // actuatorfrcrange, by joint
};

// Tendons, equalities and actuators become the torques of the joints of `robot` and its mimics.
void read_mjcf_motors(UrdfDocument& document, const MjcfDefaults& defaults, const MjcfMotorSettings& settings,
                      UrdfDescription& robot);

}  // namespace kadans
