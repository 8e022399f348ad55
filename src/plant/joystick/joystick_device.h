// A joystick as an event device of the Linux kernel: /dev/input/event5 or, by a lasting name, one of
// /dev/input/by-id/*-event-joystick.
//
// at() reads the events that have come, without blocking. It makes a few system calls, so it is for a thread beside the
// engines. A device that is unplugged reads as centred. It is looked for twice a second, so it may be plugged in again.
// Only <linux/input.h> is used: recordings are read by the same events, so a device library would add a second way.
#pragma once

#include <memory>
#include <string>

#include "signal/owned_descriptor.h"
#include "stick.h"

namespace kadans {

class JoystickDevice final : public JoystickSource {
 public:
  // Throws InputError that says what to do when it is not there, may not be read, or is no joystick.
  explicit JoystickDevice(const JoystickSettings& settings);
  // For tests, where there is no device: reads a descriptor, which it takes over, as a device with these ranges.
  JoystickDevice(const JoystickSettings& settings, int descriptor, const StickRanges& ranges);

  const JoystickState& at(std::int64_t time_ns) noexcept override;

 private:
  void read_all() noexcept;
  void read_whole() noexcept;  // axes and buttons as they are
  void lose() noexcept;

  JoystickSettings settings_;
  OwnedDescriptor descriptor_;
  Stick stick_;
  std::int64_t look_again_ns_ = 0;
};

// Opens `path`, a device or a recording; settings.device is ignored. Throws InputError.
std::unique_ptr<JoystickSource> make_joystick(const JoystickSettings& settings, const std::string& path);

}  // namespace kadans
