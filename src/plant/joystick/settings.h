// How a joystick's axes are read.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "kadans/signal/joystick.h"

namespace kadans {

struct JoystickAxis {
  std::uint16_t code = 0;   // of the kernel's input events: ABS_X is 0, ABS_Y 1, ABS_RZ 5, ABS_THROTTLE 6
  bool inverted = false;    // the kernel counts y towards the hand, and most throttles backwards
  double min = 0, max = 0;  // of its values; both 0: as the device, or the recording, says
};

struct JoystickSettings {
  std::string device;       // /dev/input/...; "": none
  double dead_zone = 0.08;  // around the middle, as a share of the way to an end
  std::array<JoystickAxis, joystick_axes> axes{
      {{.code = 0}, {.code = 1, .inverted = true}, {.code = 5}, {.code = 6, .inverted = true}}};
};

}  // namespace kadans
