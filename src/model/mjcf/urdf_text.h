// A description as the text of a URDF that reads as the same robot.
#pragma once

#include <string>

#include "model/urdf/urdf_description.h"

namespace kadans {

// Every number to its last digit.
std::string urdf_text(const UrdfDescription& robot);

}  // namespace kadans
