// Turns input events into a joystick's state. Axes are scaled to -1..1 about the middle of their range; in the dead
// zone they are 0, and they grow from 0 at its edge. Buttons keep their order: a joystick's from BTN_JOYSTICK on, a
// gamepad's from BTN_GAMEPAD on.
//
// Events take effect together, at the next SYN_REPORT. When the kernel dropped events (SYN_DROPPED), the events up to
// the next report are ignored, and take_dropped() asks the owner to read the device anew.
//
// One owner, one thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "settings.h"

namespace kadans {

// The kernel's input events, as a device gives them (Documentation/input/input.rst), and recordings of them.
//
// A recording is one of two things:
//   text   as `evemu-record /dev/input/eventN` writes it: lines "A: <axis> <min> <max> ..." (ranges; the axis in
//          hexadecimal) and "E: <seconds> <type> <code> <value>" (types and codes in hexadecimal); "#" begins a
//          comment; N, I, P, B, L and S lines are passed over;
//   bytes  as `cat /dev/input/eventN` writes them: struct input_event of this machine, one after the other. They do not
//          tell the ranges of the axes; the settings must.
// Time 0 is the first event's.
struct StickEvent {
  std::int64_t time_ns = 0;
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
};

struct StickRange {
  double min = 0, max = 0;  // both 0: not known
};
using StickRanges = std::array<StickRange, 64>;  // by the axis' code

struct StickRecording {
  std::vector<StickEvent> events;
  StickRanges ranges{};
};

// Throws InputError with the line, or the byte, that is wrong.
StickRecording read_stick_recording(const std::filesystem::path& file);
StickRecording read_stick_recording(const std::string& content, const std::string& file);

// Decodes the bytes that a read of a device returned. Returns the number of complete events. Times are the kernel's, -1
// where a time is impossible.
std::size_t decode_stick_events(std::span<const std::byte> bytes, std::span<StickEvent> events) noexcept;

class Stick {
 public:
  // Throws std::invalid_argument that names the axis, when neither the settings nor `ranges` give the range of one of
  // the first `needed` axes, or when a range is empty. An axis without a range that is not needed stays at 0.
  Stick(const JoystickSettings& settings, const StickRanges& ranges, std::size_t needed = 2);

  void take(const StickEvent& event) noexcept;
  // unplug: there is no joystick. plug: there is one.
  void unplug() noexcept { whole_ = draft_ = {}; }
  void plug() noexcept { whole_.connected = draft_.connected = true; }
  // True once after events were dropped: the present state must be read from the device.
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
  // The state at this time on the engine's clock; the time never goes back. Does not block.
  virtual const JoystickState& at(std::int64_t time_ns) noexcept = 0;
};

// Plays a recording from from_ns on. After the last event the state stays. From lost_ns on the joystick is unplugged.
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
