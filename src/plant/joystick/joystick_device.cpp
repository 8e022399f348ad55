#include "joystick_device.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>

#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t look_again_ns = 500'000'000;
constexpr std::size_t batch = 64, batches_max = 16;
constexpr std::size_t key_bytes = KEY_CNT / 8;

std::string joysticks_here() {
  std::string all;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/input/by-id", ignored)) {
    const std::string name = entry.path().string();
    if (name.ends_with("-event-joystick")) all += (all.empty() ? "; there is " : ", ") + name;
  }
  return all.empty() ? "; no joystick is plugged in" : all;
}

std::string why_not(int error) {
  if (error == EACCES || error == EPERM)
    return "may not be read: its group is 'input'; join it with `sudo usermod -aG input $USER` and log in again";
  if (error == ENOENT || error == ENODEV || error == ENXIO) return "there is no such device" + joysticks_here();
  return std::string("cannot be opened: ") + std::strerror(error);  // NOLINT(concurrency-mt-unsafe): before the loop
}

OwnedDescriptor open_device(const std::string& path) noexcept {
  return OwnedDescriptor(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
}

// False: it is no input device.
bool read_ranges(int descriptor, StickRanges& ranges) noexcept {
  int protocol = 0;
  if (ioctl(descriptor, EVIOCGVERSION, &protocol) < 0) return false;
  for (std::size_t axis = 0; axis < ranges.size(); ++axis) {
    input_absinfo info{};
    if (ioctl(descriptor, EVIOCGABS(axis), &info) < 0) continue;
    ranges[axis] = {static_cast<double>(info.minimum), static_cast<double>(info.maximum)};
  }
  return true;
}

Stick open_stick(const JoystickSettings& settings, OwnedDescriptor& descriptor) {
  descriptor = open_device(settings.device);
  if (!descriptor) refuse(settings.device, why_not(errno));
  try {
    StickRanges ranges{};
    if (!read_ranges(descriptor.number(), ranges))
      throw std::invalid_argument("is no event device of Linux" + joysticks_here());
    return {settings, ranges};
  } catch (const std::exception& error) {
    refuse(settings.device, error.what());
  }
}

}  // namespace

JoystickDevice::JoystickDevice(const JoystickSettings& settings)
    : settings_(settings), stick_(open_stick(settings, descriptor_)) {
  stick_.plug();
  read_whole();
}

JoystickDevice::JoystickDevice(const JoystickSettings& settings, int descriptor, const StickRanges& ranges)
    : settings_(settings), descriptor_(descriptor), stick_(settings, ranges) {
  stick_.plug();
}

// The ranges stay those of the first one: who plugs in another kind begins anew.
const JoystickState& JoystickDevice::at(std::int64_t time_ns) noexcept {
  if (!descriptor_ && time_ns >= look_again_ns_ && !settings_.device.empty()) {
    look_again_ns_ = time_ns + look_again_ns;
    descriptor_ = open_device(settings_.device);
    if (descriptor_) {
      stick_.plug();
      read_whole();
    }
  }
  if (descriptor_) read_all();
  return stick_.state();
}

void JoystickDevice::read_all() noexcept {
  std::array<input_event, batch> raw;  // NOLINT(cppcoreguidelines-pro-type-member-init): read into
  std::array<StickEvent, batch> events;
  for (std::size_t i = 0; i < batches_max; ++i) {
    const ssize_t bytes = read(descriptor_.number(), raw.data(), sizeof raw);
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (bytes <= 0) return lose();
    const auto got = std::as_bytes(std::span(raw)).first(static_cast<std::size_t>(bytes));
    const std::size_t count = decode_stick_events(got, events);
    for (std::size_t k = 0; k < count; ++k) stick_.take(events[k]);
    if (stick_.take_dropped()) read_whole();
    if (count < batch) return;
  }
}

void JoystickDevice::read_whole() noexcept {
  for (const JoystickAxis& axis : settings_.axes) {
    input_absinfo info{};
    if (ioctl(descriptor_.number(), EVIOCGABS(axis.code), &info) >= 0) stick_.take({0, EV_ABS, axis.code, info.value});
  }
  std::array<unsigned char, key_bytes> keys{};
  if (ioctl(descriptor_.number(), EVIOCGKEY(key_bytes), keys.data()) >= 0) {
    const auto held = [&keys](std::size_t key) { return (keys[key / 8] >> (key % 8) & 1) != 0; };
    for (std::size_t i = 0; i < joystick_buttons; ++i) {
      const bool any = held(BTN_JOYSTICK + i) || held(BTN_GAMEPAD + i);
      stick_.take({0, EV_KEY, static_cast<std::uint16_t>(BTN_JOYSTICK + i), any ? 1 : 0});
    }
  }
  stick_.take({0, EV_SYN, SYN_REPORT, 0});
}

void JoystickDevice::lose() noexcept {
  descriptor_ = {};
  stick_.unplug();
}

std::unique_ptr<JoystickSource> make_joystick(const JoystickSettings& settings, const std::string& path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) {
    try {
      return std::make_unique<JoystickPlayer>(settings, path);
    } catch (const std::invalid_argument& error) {
      refuse(path, error.what());
    }
  }
  JoystickSettings of_device = settings;
  of_device.device = path;
  return std::make_unique<JoystickDevice>(of_device);
}

}  // namespace kadans
