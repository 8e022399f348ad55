#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <linux/input.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "plant/joystick/joystick_device.h"

namespace joystick_test {

using namespace kadans;
namespace fs = std::filesystem;

namespace {

constexpr std::int64_t ms = 1'000'000;

StickRanges ranges_of(double min, double max) {
  StickRanges ranges{};
  ranges[ABS_X] = ranges[ABS_Y] = {min, max};
  return ranges;
}

input_event raw(std::uint16_t type, std::uint16_t code, std::int32_t value, std::int64_t time_us = 0) {
  input_event event{};
  event.input_event_sec = time_us / 1'000'000;
  event.input_event_usec = time_us % 1'000'000;
  event.type = type;
  event.code = code;
  event.value = value;
  return event;
}

std::string bytes_of(const std::vector<input_event>& events) {
  return {reinterpret_cast<const char*>(events.data()), events.size() * sizeof(input_event)};
}

std::string refusal(const std::string& content) {
  try {
    (void)read_stick_recording(content, "it");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// A stick after each of these events and a report.
JoystickState after(Stick& stick, const std::vector<StickEvent>& events) {
  for (const StickEvent& event : events) stick.take(event);
  stick.take({0, EV_SYN, SYN_REPORT, 0});
  return stick.state();
}

struct Pipe {
  std::array<int, 2> ends{};
  Pipe() { REQUIRE(pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) == 0); }
  void send(const std::vector<input_event>& events) const {
    const std::string bytes = bytes_of(events);
    REQUIRE(write(ends[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
};

}  // namespace

TEST_CASE("A stick's axes go from -1 to 1, y away from the hand, with nothing in the dead zone") {
  JoystickSettings settings;
  settings.dead_zone = 0.1;
  Stick stick(settings, ranges_of(0, 1000));
  CHECK(after(stick, {{0, EV_ABS, ABS_X, 1000}, {0, EV_ABS, ABS_Y, 0}}).axes[0] == 1);
  CHECK(stick.state().axes[1] == 1);
  CHECK(after(stick, {{0, EV_ABS, ABS_X, 540}}).axes[0] == 0);
  CHECK(after(stick, {{0, EV_ABS, ABS_X, 775}}).axes[0] == doctest::Approx(0.5));
  CHECK(after(stick, {{0, EV_ABS, ABS_X, 0}}).axes[0] == -1);
  CHECK(after(stick, {{0, EV_ABS, ABS_X, 5000}}).axes[0] == 1);  // worn beyond its range
}

TEST_CASE("A stick takes the range of its settings before the device's, and refuses to go without one") {
  JoystickSettings settings;
  settings.axes[0].min = 100;
  settings.axes[0].max = 300;
  Stick stick(settings, ranges_of(0, 1000));
  CHECK(after(stick, {{0, EV_ABS, ABS_X, 300}}).axes[0] == 1);
  CHECK_THROWS_WITH_AS(Stick(JoystickSettings{}, StickRanges{}),
                       "the range of the joystick's axis 'x' is not known: say joystick.axes.x.min and .max",
                       std::invalid_argument);
}

TEST_CASE("A stick changes with whole reports only, and asks to be read anew when events were dropped") {
  Stick stick({}, ranges_of(-100, 100));
  stick.take({0, EV_ABS, ABS_X, 100});
  CHECK(stick.state().axes[0] == 0);
  CHECK(after(stick, {}).axes[0] == 1);
  CHECK_FALSE(stick.take_dropped());
  stick.take({0, EV_SYN, SYN_DROPPED, 0});
  CHECK(after(stick, {{0, EV_ABS, ABS_X, -100}}).axes[0] == 1);
  CHECK(stick.take_dropped());
}

TEST_CASE("A joystick's trigger and a gamepad's first button are both button 1") {
  for (const std::uint16_t first : {std::uint16_t{BTN_JOYSTICK}, std::uint16_t{BTN_GAMEPAD}}) {
    Stick stick({}, ranges_of(-100, 100));
    CHECK(after(stick, {{0, EV_KEY, first, 1}}).buttons[0]);
    CHECK_FALSE(after(stick, {{0, EV_KEY, first, 0}}).buttons[0]);
    CHECK_FALSE(after(stick, {{0, EV_KEY, static_cast<std::uint16_t>(first + 8), 1}}).buttons[0]);
  }
}

TEST_CASE("A recording is read as evemu-record writes it, or as cat does") {
  const std::string text =
      "# EVEMU 1.3\nN: A stick\nA: 00 0 255 0 15 0\nA: 01 -5 5 0 0\n"
      "E: 2.000000 0003 0000 0200\t# EV_ABS / ABS_X 200\nE: 2.010000 0000 0000 0\n";
  const StickRecording from_text = read_stick_recording(text, "it");
  CHECK(from_text.ranges[0].max == 255);
  CHECK(from_text.ranges[1].min == -5);
  REQUIRE(from_text.events.size() == 2);
  CHECK(from_text.events[0].value == 200);
  CHECK(from_text.events[0].time_ns == 0);
  CHECK(from_text.events[1].time_ns == 10 * ms);
  const StickRecording from_bytes =
      read_stick_recording(bytes_of({raw(EV_ABS, ABS_X, 200, 2'000'000), raw(EV_SYN, SYN_REPORT, 0, 2'010'000)}), "it");
  REQUIRE(from_bytes.events.size() == 2);
  CHECK(from_bytes.events[0].code == ABS_X);
  CHECK(from_bytes.events[0].value == 200);
  CHECK(from_bytes.events[1].time_ns == 10 * ms);
}

TEST_CASE("A wrong recording is refused with its line") {
  CHECK(refusal("A: 00 0 255\nE: soon 0003 0000 1\n") ==
        "it:2:1: must be \"E: <seconds> <type> <code> <value>\", type and code in hexadecimal");
  CHECK(refusal("E: 2.0 0003 0000 1\nE: 1.0 0003 0000 1\n") == "it:2:1: goes back in time");
  CHECK(refusal("{ \"no\": 1 }\n").find("it:1:1: is no line of an evemu recording") == 0);
  CHECK(refusal("# nothing\n") == "it: holds no event of a joystick");
  std::string cut = bytes_of({raw(EV_SYN, SYN_REPORT, 0)});
  cut.pop_back();
  CHECK(refusal(cut).find("are not a multiple of the") != std::string::npos);
}

TEST_CASE("A recording whose times cannot be counted in nanoseconds is refused") {
  CHECK(refusal("E: 9500000000 0003 0000 1\n").find("it:1:1: must be") == 0);
  if (sizeof(input_event::time.tv_sec) < sizeof(std::int64_t)) return;  // all that fit in can be counted
  CHECK(refusal(bytes_of({raw(EV_SYN, SYN_REPORT, 0), raw(EV_SYN, SYN_REPORT, 0, INT64_MAX)})) ==
        "it: event 2 has a time that none can have");
  CHECK(refusal(bytes_of({raw(EV_SYN, SYN_REPORT, 0, INT64_MIN)})) == "it: event 1 has a time that none can have");
}

TEST_CASE("A recording is played from its time on, and is unplugged when the scenario says so") {
  const fs::path file = fs::temp_directory_path() / ("stick-" + std::to_string(getpid()) + ".evemu");
  std::ofstream(file) << "A: 00 -10 10\nA: 01 -10 10\nE: 5.0 0000 0000 0\nE: 5.5 0003 0000 10\nE: 5.5 0000 0000 0\n";
  JoystickPlayer player({}, file, 1000 * ms, 2000 * ms);
  fs::remove(file);
  CHECK(player.at(0).connected);
  CHECK(player.at(1499 * ms).axes[0] == 0);
  CHECK(player.at(1500 * ms).axes[0] == 1);
  CHECK(player.at(1999 * ms).axes[0] == 1);
  CHECK(player.at(2000 * ms).axes[0] == 0);
  CHECK_FALSE(player.at(3000 * ms).connected);
}

TEST_CASE("A device is read without waiting, and reads as centred once it is gone") {
  const Pipe pipe;
  JoystickDevice device({}, pipe.ends[0], ranges_of(-100, 100));
  CHECK(device.at(0).connected);
  CHECK(device.at(0).axes[0] == 0);
  pipe.send({raw(EV_ABS, ABS_X, 100), raw(EV_KEY, BTN_JOYSTICK, 1), raw(EV_SYN, SYN_REPORT, 0)});
  CHECK(device.at(0).axes[0] == 1);
  CHECK(device.at(0).buttons[0]);
  close(pipe.ends[1]);
  CHECK_FALSE(device.at(0).connected);
  CHECK(device.at(1000 * ms).axes[0] == 0);
  CHECK_FALSE(device.at(1000 * ms).buttons[0]);
}

TEST_CASE("What is no joystick is refused before the run, with what is wrong") {
  const auto why = [](const std::string& path) -> std::string {
    try {
      (void)make_joystick({}, path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(why("/dev/input/event-none").find("/dev/input/event-none: there is no such device") == 0);
  CHECK(why("/dev/null").find("/dev/null: is no event device of Linux") == 0);
}

namespace {

// A virtual joystick of the kernel; its device's path is "" where the machine allows none.
class VirtualStick {
 public:
  VirtualStick() : descriptor_(open("/dev/uinput", O_WRONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (descriptor_ < 0) return;
    uinput_setup setup{};
    setup.id.bustype = BUS_VIRTUAL;
    std::strcpy(setup.name, "kadans test stick");
    bool good = ioctl(descriptor_, UI_SET_EVBIT, EV_KEY) >= 0 && ioctl(descriptor_, UI_SET_KEYBIT, BTN_JOYSTICK) >= 0;
    for (const std::uint16_t axis : {std::uint16_t{ABS_X}, std::uint16_t{ABS_Y}}) {
      uinput_abs_setup abs{};
      abs.code = axis;
      abs.absinfo.minimum = -100;
      abs.absinfo.maximum = 100;
      good = good && ioctl(descriptor_, UI_ABS_SETUP, &abs) >= 0;
    }
    std::array<char, 64> name{};
    if (!good || ioctl(descriptor_, UI_DEV_SETUP, &setup) < 0 || ioctl(descriptor_, UI_DEV_CREATE) < 0 ||
        ioctl(descriptor_, UI_GET_SYSNAME(name.size()), name.data()) < 0)
      return;
    std::error_code ignored;
    for (const auto& entry :
         fs::directory_iterator("/sys/devices/virtual/input/" + std::string(name.data()), ignored)) {
      const std::string event = entry.path().filename().string();
      if (event.starts_with("event") && access(("/dev/input/" + event).c_str(), R_OK) == 0)
        path = "/dev/input/" + event;
    }
  }
  ~VirtualStick() { unplug(); }
  VirtualStick(const VirtualStick&) = delete;
  VirtualStick& operator=(const VirtualStick&) = delete;

  void send(const std::vector<input_event>& events) const {
    const std::string bytes = bytes_of(events);
    REQUIRE(write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
  void unplug() {
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
  }
  std::string path;

 private:
  int descriptor_;
};

}  // namespace

TEST_CASE("A joystick of the kernel is read, and may be pulled out") {
  VirtualStick virtual_stick;
  if (virtual_stick.path.empty()) {
    MESSAGE("this machine allows no virtual joystick: /dev/uinput cannot be used");
    return;
  }
  const auto device = make_joystick({}, virtual_stick.path);
  virtual_stick.send({raw(EV_ABS, ABS_X, 100), raw(EV_KEY, BTN_JOYSTICK, 1), raw(EV_SYN, SYN_REPORT, 0)});
  CHECK(device->at(0).axes[0] == 1);
  CHECK(device->at(0).buttons[0]);
  virtual_stick.unplug();
  CHECK_FALSE(device->at(0).connected);
}

}  // namespace joystick_test
