// A joystick of the Linux kernel: an event device, /dev/input/event5 or, by a name that stays, one of
// /dev/input/by-id/*-event-joystick.
//
// at() reads what has come without blocking: a few system calls, so it is for a thread beside the engines. A device
// that goes away reads as centred; it is looked for again twice a second, so it may be plugged in anew. The calls are
// those of <linux/input.h> alone: a recording is taken in the same way, so a library for devices would be a second one.
#pragma once

#include <memory>
#include <string>

#include "kadans/plant/joystick/stick.h"

namespace kadans {

class JoystickDevice final : public JoystickSource {
 public:
  // Throws InputError that says what to do when it is not there, may not be read, or is no joystick.
  explicit JoystickDevice(const JoystickSettings& settings);
  // Reads a descriptor that it takes over, of a device whose ranges are given: for tests, where there is none.
  JoystickDevice(const JoystickSettings& settings, int descriptor, const StickRanges& ranges);
  ~JoystickDevice() override;
  JoystickDevice(const JoystickDevice&) = delete;
  JoystickDevice& operator=(const JoystickDevice&) = delete;

  const JoystickState& at(std::int64_t time_ns) noexcept override;

 private:
  void read_all() noexcept;
  void read_whole() noexcept;  // axes and buttons as they are
  void lose() noexcept;

  JoystickSettings settings_;
  int descriptor_ = -1;
  Stick stick_;
  std::int64_t look_again_ns_ = 0;
};

// A device or a recording, by what `path` is; `settings.device` does not count. Throws InputError.
std::unique_ptr<JoystickSource> make_joystick(const JoystickSettings& settings, const std::string& path);

}  // namespace kadans
