// From input events to a joystick's state: axes from the middle of their range to -1..1, with a dead zone from whose
// edge they begin at 0; buttons in their order, a joystick's from BTN_JOYSTICK on, a gamepad's from BTN_GAMEPAD on.
//
// What events say counts once they are reported whole (SYN_REPORT). When the kernel says that it dropped some
// (SYN_DROPPED), the rest up to the next report is passed over, and the owner is asked to read the device anew.
//
// One owner, one thread.
#pragma once

#include "kadans/plant/joystick/settings.h"
#include "kadans/plant/joystick/stick_events.h"

namespace kadans {

class Stick {
 public:
  // Throws std::invalid_argument that names the axis when neither says the range of one of `needed` axes, or when it is
  // empty. An axis without a range that is not needed stays at 0.
  Stick(const JoystickSettings& settings, const StickRanges& ranges, std::size_t needed = 2);

  void take(const StickEvent& event) noexcept;
  // There is none any more, or not yet; and there is one.
  void unplug() noexcept { whole_ = draft_ = {}; }
  void plug() noexcept { whole_.connected = draft_.connected = true; }
  // True once after events were dropped: what is now must be read from the device.
  bool take_dropped() noexcept;

  const JoystickState& state() const noexcept { return whole_; }

 private:
  double calibrated(std::size_t axis, double value) const noexcept;

  JoystickSettings settings_;
  JoystickState draft_, whole_;
  bool dropping_ = false, dropped_ = false;
};

// Where a joystick's state comes from: a device, or a recording of one.
class JoystickSource {
 public:
  virtual ~JoystickSource() = default;
  // How it is at this time on the engine's clock, which does not go back. Does not block.
  virtual const JoystickState& at(std::int64_t time_ns) noexcept = 0;
};

// A recording, played from a time on; it stays as its last event left it. From `lost_ns` on it is unplugged.
class JoystickPlayer final : public JoystickSource {
 public:
  // Throws InputError, or std::invalid_argument when the recording does not say an axis' range and the settings do not
  // either.
  JoystickPlayer(const JoystickSettings& settings, const std::filesystem::path& file, std::int64_t from_ns = 0,
                 std::int64_t lost_ns = INT64_MAX);
  const JoystickState& at(std::int64_t time_ns) noexcept override;

 private:
  StickRecording recording_;
  Stick stick_;
  std::size_t next_ = 0;
  std::int64_t from_ns_, lost_ns_;
};

}  // namespace kadans
