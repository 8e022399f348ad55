// Recordings of joysticks (text of evemu, or input events as bytes), and the same bytes from a device: what is read is
// in order and in range, and is the same when it is written as text and read again.
#include <array>
#include <cmath>
#include <stdexcept>

#include <fcntl.h>

#include "fuzz_input.h"
#include "plant/joystick/joystick_device.h"

namespace {

using namespace kadans;
using fuzz::require;

void require_in_range(const JoystickState& state) {
  for (const double axis : state.axes) require(axis >= -1 && axis <= 1, "an axis lies in -1..1");
}

StickRanges usual_ranges() {
  StickRanges ranges{};
  ranges.fill({0, 255});
  return ranges;
}

void play_as_device(std::string_view bytes) {
  std::array<int, 2> ends{};
  require(pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) == 0, "there are pipes");
  JoystickDevice device({}, ends[0], usual_ranges());
  require(write(ends[1], bytes.data(), bytes.size()) == std::ssize(bytes), "a pipe takes an input");
  require_in_range(device.at(0));
  close(ends[1]);
  for (int i = 0; i < 3; ++i) require_in_range(device.at(i));
  require(!device.at(4).connected, "a device that is gone is not connected");
}

std::string text_of(const StickRecording& recording) {
  std::string text;
  for (std::size_t i = 0; i < recording.ranges.size(); ++i) {
    char line[64];
    const StickRange& range = recording.ranges[i];
    std::snprintf(line, sizeof line, "A: %02zx %.0f %.0f 0 0\n", i, range.min, range.max);
    text += line;
  }
  for (const StickEvent& event : recording.events) {
    char line[96];
    std::snprintf(line, sizeof line, "E: %lld.%06lld %04x %04x %d\n",
                  static_cast<long long>(event.time_ns / 1'000'000'000),
                  static_cast<long long>(event.time_ns / 1000 % 1'000'000), static_cast<unsigned>(event.type),
                  static_cast<unsigned>(event.code), event.value);
    text += line;
  }
  return text;
}

bool same(const StickRecording& a, const StickRecording& b) {
  const auto same_event = [](const StickEvent& x, const StickEvent& y) {
    return x.time_ns == y.time_ns && x.type == y.type && x.code == y.code && x.value == y.value;
  };
  const auto same_range = [](const StickRange& x, const StickRange& y) { return x.min == y.min && x.max == y.max; };
  return std::ranges::equal(a.events, b.events, same_event) && std::ranges::equal(a.ranges, b.ranges, same_range);
}

void require_right(const StickRecording& recording) {
  require(!recording.events.empty() && recording.events.front().time_ns == 0, "time begins with the first event");
  for (std::size_t i = 1; i < recording.events.size(); ++i)
    require(recording.events[i - 1].time_ns <= recording.events[i].time_ns, "time goes forward");
  for (const StickRange& range : recording.ranges)
    require(range.min < range.max || (range.min == 0 && range.max == 0), "a range is known or not");
  constexpr std::int64_t longest_ns = std::int64_t{1'000'000} * 1'000'000'000;  // of which a double tells microseconds
  if (recording.events.back().time_ns <= longest_ns)
    require(same(recording, read_stick_recording(text_of(recording), "again")), "as text it reads the same");
}

void play(const std::string& content) {
  const fuzz::MemoryFile file(content);
  try {
    JoystickPlayer player({}, file.path(), 500, 2'000'000'000);
    for (const std::int64_t time_ns : {std::int64_t{0}, std::int64_t{1'000'000'000}, INT64_MAX})
      require_in_range(player.at(time_ns));
  } catch (const std::invalid_argument&) {  // neither says the range of an axis
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content(reinterpret_cast<const char*>(data), size);
  play_as_device(content);
  try {
    require_right(read_stick_recording(content, "it"));
    play(content);
  } catch (const InputError& error) {
    fuzz::require_told(error, "it", fuzz::Placed::nowhere);
  }
  return 0;
}
