// The texts about a robot that viewers need before the first value.
#pragma once

#include <string>

#include "telemetry/record/viewer_messages.h"

namespace kadans {

struct RobotTexts {
  std::string name, urdf;
  std::string description;  // run_description.h
  ViewerSubjects subjects;
};

}  // namespace kadans
