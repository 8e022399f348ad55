// Events that inputs of the robot send to the behaviors.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/json/problems.h"

namespace kadans {

class Fields;

// A button of the joystick, or a sensor that counts as on above 0.5. Either event may be "": none.
struct InputEvent {
  enum class Of : std::uint8_t { button, sensor };
  Of of = Of::button;
  std::uint32_t index = 0;  // of the button, or of the sensor in RobotStatus::channels
  std::string input{};      // "joystick.button_1", "sensors.bumper"
  std::string rise{}, fall{};
};

// The fields of one input, whose events `rise` and `fall` are; with an event of either it goes to `all`.
void input_event_fields(Fields& f, InputEvent event, const char* rise, const char* fall, std::vector<InputEvent>& all);
// An entry of a map of buttons: "button_1": { "press": "kick", "release": "rest" }.
void button_fields(Fields& entry, std::vector<InputEvent>& all);
inline constexpr const char* buttons_doc = "events that buttons send to behaviors: button_1 and so on";

// Those of `all`, and of `own` where both are about the same input.
std::vector<InputEvent> overridden(std::vector<InputEvent> all, const std::vector<InputEvent>& own);

}  // namespace kadans
