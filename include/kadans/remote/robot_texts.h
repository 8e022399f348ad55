// What viewers need of a robot before its first number.
#pragma once

#include <string>

namespace kadans {

struct RobotTexts {
  std::string name, urdf;
  std::string description;  // run_description.h
};

}  // namespace kadans
