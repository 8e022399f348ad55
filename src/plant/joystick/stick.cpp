#include "stick.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <linux/input.h>

namespace kadans {

Stick::Stick(const JoystickSettings& settings, const StickRanges& ranges, std::size_t needed) : settings_(settings) {
  for (std::size_t i = 0; i < joystick_axes; ++i) {
    JoystickAxis& axis = settings_.axes[i];
    const StickRange known = axis.code < ranges.size() ? ranges[axis.code] : StickRange{};
    if (axis.min == 0 && axis.max == 0) {
      axis.min = known.min;
      axis.max = known.max;
    }
    if (axis.min < axis.max || (axis.min == axis.max && i >= needed)) continue;
    throw std::invalid_argument("the range of the joystick's axis '" + std::string(joystick_axis_names[i]) +
                                "' is not known: say joystick.axes." + joystick_axis_names[i] + ".min and .max");
  }
}

double Stick::calibrated(std::size_t i, double value) const noexcept {
  const JoystickAxis& axis = settings_.axes[i];
  if (!(axis.min < axis.max)) return 0;
  const double out = std::clamp((2 * value - axis.min - axis.max) / (axis.max - axis.min), -1.0, 1.0);
  const double beyond = std::abs(out) - settings_.dead_zone;
  if (!(beyond > 0)) return 0;
  return std::copysign(beyond / (1 - settings_.dead_zone), axis.inverted ? -out : out);
}

void Stick::take(const StickEvent& event) noexcept {
  if (event.type == EV_SYN) {
    if (event.code == SYN_DROPPED) {
      dropping_ = true;
    } else if (event.code == SYN_REPORT && dropping_) {
      dropping_ = false;
      dropped_ = true;
    } else if (event.code == SYN_REPORT) {
      whole_ = draft_;
    }
    return;
  }
  if (dropping_) return;
  if (event.type == EV_ABS) {
    for (std::size_t i = 0; i < joystick_axes; ++i) {
      if (settings_.axes[i].code == event.code) draft_.axes[i] = calibrated(i, event.value);
    }
  } else if (event.type == EV_KEY) {
    const int first = event.code >= BTN_GAMEPAD ? BTN_GAMEPAD : BTN_JOYSTICK;
    const int button = event.code - first;
    if (button >= 0 && button < static_cast<int>(joystick_buttons))
      draft_.buttons[static_cast<std::size_t>(button)] = event.value != 0;
  }
}

bool Stick::take_dropped() noexcept {
  const bool dropped = dropped_;
  dropped_ = false;
  return dropped;
}

JoystickPlayer::JoystickPlayer(const JoystickSettings& settings, const std::filesystem::path& file,
                               std::int64_t from_ns, std::int64_t lost_ns)
    : recording_(read_stick_recording(file)),
      stick_(settings, recording_.ranges),
      from_ns_(from_ns),
      lost_ns_(lost_ns) {
  stick_.plug();
}

const JoystickState& JoystickPlayer::at(std::int64_t time_ns) noexcept {
  if (time_ns >= lost_ns_) stick_.unplug();
  if (time_ns >= lost_ns_) return stick_.state();
  while (next_ < recording_.events.size() && recording_.events[next_].time_ns <= time_ns - from_ns_) {
    stick_.take(recording_.events[next_++]);
  }
  return stick_.state();
}

}  // namespace kadans
