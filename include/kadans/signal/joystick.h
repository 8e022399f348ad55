// The state of a joystick: where its axes are and which buttons are held. A joystick that is not there, or was
// unplugged, is centred with no button held.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

namespace kadans {

inline constexpr std::size_t joystick_axes = 4;
inline constexpr std::size_t joystick_buttons = 8;
inline constexpr std::array<const char*, joystick_axes> joystick_axis_names{"x", "y", "twist", "throttle"};

struct alignas(8) JoystickState {
  // In the order of their names, each -1..1, 0 within the dead zone: to the right, away from the hand, clockwise from
  // above, throttle forward.
  std::array<double, joystick_axes> axes{};
  std::array<bool, joystick_buttons> buttons{};
  bool connected = false;
};
static_assert(std::is_trivially_copyable_v<JoystickState> && sizeof(JoystickState) == 48);

}  // namespace kadans
