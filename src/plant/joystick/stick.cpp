#include "stick.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <linux/input.h>

#include "kadans/signal/input_error.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::int64_t time_max_s = 9'000'000'000;  // of which the nanoseconds can be counted

// -1: no time that a device says.
std::int64_t time_of(const input_event& event) noexcept {
  const std::int64_t s = event.input_event_sec, us = event.input_event_usec;
  return s >= 0 && s < time_max_s && us >= 0 && us < 1'000'000 ? s * 1'000'000'000 + us * 1000 : -1;
}

// The words of one line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r"));
    rest_.remove_prefix(word.size());
    return word;
  }
  template <typename T>
  std::optional<T> integer(int base) {
    return number_of<T>(next(), base);
  }
  std::optional<std::int64_t> seconds_as_ns() {
    const std::optional<double> value_s = number_of<double>(next());
    if (!value_s || !(*value_s >= 0 && *value_s < static_cast<double>(time_max_s))) return std::nullopt;
    return std::llround(*value_s * 1e6) * 1000;  // the kernel counts microseconds
  }

 private:
  std::string_view rest_;
};

class TextRecording {
 public:
  explicit TextRecording(const std::string& file) : file_(file) {}

  void take(std::string_view line) {
    ++line_;
    line = line.substr(0, line.find('#'));
    Words words(line);
    const std::string_view kind = words.next();
    if (kind.empty()) return;
    if (kind == "A:") return range(words);
    if (kind == "E:") return event(words);
    if (kind.size() == 2 && kind[1] == ':' && std::string_view("NIPBLS").find(kind[0]) != std::string_view::npos)
      return;
    refuse("is no line of an evemu recording: they begin with A:, E:, N:, I:, P:, B:, L:, S: or #");
  }
  StickRecording recording;

 private:
  void range(Words& words) {
    const auto axis = words.integer<std::uint16_t>(16);
    const auto min = words.integer<std::int32_t>(10);
    const auto max = words.integer<std::int32_t>(10);
    if (!axis || !min || !max || *axis >= recording.ranges.size())
      refuse("must be \"A: <axis> <min> <max> ...\", the axis in hexadecimal, 0..3f");
    if (*min < *max) recording.ranges[*axis] = {static_cast<double>(*min), static_cast<double>(*max)};
  }
  void event(Words& words) {
    const auto time_ns = words.seconds_as_ns();
    const auto type = words.integer<std::uint16_t>(16);
    const auto code = words.integer<std::uint16_t>(16);
    const auto value = words.integer<std::int32_t>(10);
    if (!time_ns || !type || !code || !value)
      refuse("must be \"E: <seconds> <type> <code> <value>\", type and code in hexadecimal");
    if (!recording.events.empty() && *time_ns < recording.events.back().time_ns) refuse("goes back in time");
    recording.events.push_back({*time_ns, *type, *code, *value});
  }
  [[noreturn]] void refuse(const char* why) const { throw InputError({file_, line_, 1, why}); }

  std::string file_;
  int line_ = 0;
};

StickRecording read_text(std::string_view content, const std::string& file) {
  TextRecording text(file);
  while (!content.empty()) {
    const std::size_t end = std::min(content.find('\n'), content.size());
    text.take(content.substr(0, end));
    content.remove_prefix(std::min(end + 1, content.size()));
  }
  return std::move(text.recording);
}

StickRecording read_bytes(const std::string& content, const std::string& file) {
  StickRecording recording;
  const std::size_t whole = content.size() / sizeof(input_event);
  if (whole * sizeof(input_event) != content.size())
    refuse(file, "is no recording of input events: " + std::to_string(content.size()) +
                     " bytes are not a multiple of the " + std::to_string(sizeof(input_event)) +
                     " that an event has on this machine");
  recording.events.resize(whole);
  decode_stick_events(std::as_bytes(std::span(content)), recording.events);
  std::int64_t before_ns = 0;
  for (std::size_t i = 0; i < whole; ++i) {
    const std::int64_t time_ns = recording.events[i].time_ns;
    const std::string event = "event " + std::to_string(i + 1);
    if (time_ns < 0) refuse(file, event + " has a time that none can have");
    if (time_ns < before_ns) refuse(file, "goes back in time at " + event);
    before_ns = time_ns;
  }
  return recording;
}

}  // namespace

std::size_t decode_stick_events(std::span<const std::byte> bytes, std::span<StickEvent> events) noexcept {
  const std::size_t count = std::min(bytes.size() / sizeof(input_event), events.size());
  for (std::size_t i = 0; i < count; ++i) {
    input_event event;
    std::memcpy(&event, bytes.data() + i * sizeof event, sizeof event);
    events[i] = {time_of(event), event.type, event.code, event.value};
  }
  return count;
}

StickRecording read_stick_recording(const std::string& content, const std::string& file) {
  // Text has no zeros, events are full of them.
  const bool text = content.find('\0') == std::string::npos;
  StickRecording recording = text ? read_text(content, file) : read_bytes(content, file);
  if (recording.events.empty()) refuse(file, "holds no event of a joystick");
  const std::int64_t first_ns = recording.events.front().time_ns;
  for (StickEvent& event : recording.events) event.time_ns -= first_ns;
  return recording;
}

StickRecording read_stick_recording(const std::filesystem::path& file) {
  return read_stick_recording(read_input_file(file), file.string());
}

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

bool Stick::take_dropped() noexcept { return std::exchange(dropped_, false); }

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
