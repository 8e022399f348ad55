// The part of a robot's configuration that stands on its joystick.
#include <algorithm>

#include "robot_reader.h"

namespace kadans {
namespace {

const std::vector<std::string> axis_names{joystick_axis_names.begin(), joystick_axis_names.end()};
constexpr std::uint64_t axis_code_max = 63;
constexpr NumberRange any_value{-2147483648.0, 2147483647.0, ""};

void axis_fields(Fields& f, JoystickAxis& axis, Problems& problems) {
  f.integer("code", axis.code, {0, axis_code_max}, "the kernel's number of the axis, as `evtest` shows it");
  f.boolean("inverted", axis.inverted, "the axis counts the other way round");
  f.number("min", axis.min, any_value, "its value at one end, else what the device says");
  f.number("max", axis.max, any_value, "its value at the other end");
  if (f.has("min") == f.has("max") && (!f.has("min") || axis.min < axis.max)) return;
  problems.add(f.place("min"), f.path() + ": min and max go together, and min is less");
}

}  // namespace

void RobotReader::joystick(Fields& f) {
  JoystickSettings& settings = config_.joystick;
  config_.engine.joystick = true;
  f.string("device", settings.device, "what `kadans run` reads, such as /dev/input/by-id/NAME-event-joystick");
  f.number("dead_zone", settings.dead_zone, {0, 0.9}, "around the middle of an axis, as a share of the way to an end");
  f.map("axes", "how axes are read: x, y, twist, throttle", [&](Fields& entry) {
    const auto axis = std::ranges::find(joystick_axis_names, std::string_view(entry.key()));
    JoystickAxis scratch;
    const bool known = axis != joystick_axis_names.end();
    if (entry.reading() && !known) problems_.add_unknown(entry.key_place(), "axis", entry.key(), axis_names);
    axis_fields(entry, known ? settings.axes[static_cast<std::size_t>(axis - joystick_axis_names.begin())] : scratch,
                problems_);
  });
}

}  // namespace kadans
