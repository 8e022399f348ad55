// Events that inputs of the robot send to the behaviors.
#pragma once

#include <cstdint>
#include <string>

namespace kadans {

// A button of the joystick, or a sensor that counts as on above 0.5. Either event may be "": none.
struct InputEvent {
  enum class Of : std::uint8_t { button, sensor };
  Of of = Of::button;
  std::uint32_t index = 0;  // of the button, or of the sensor in RobotStatus::channels
  std::string input{};      // "joystick.button_1", "sensors.bumper"
  std::string rise{}, fall{};
};

}  // namespace kadans
