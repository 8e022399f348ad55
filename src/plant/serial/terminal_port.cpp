#include <algorithm>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "serial_port.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

[[noreturn]] void refuse_device(const std::string& device, const std::string& why) {
  refuse("the serial port " + device + ": " + why);
}

std::string words_of(int error) { return std::system_category().message(error); }

// A wish: not every driver has it.
void ask_for_low_latency(int descriptor) {
  serial_struct serial{};
  if (ioctl(descriptor, TIOCGSERIAL, &serial) != 0) return;
  serial.flags |= ASYNC_LOW_LATENCY;
  (void)ioctl(descriptor, TIOCSSERIAL, &serial);
}

// How long a USB adapter may keep bytes back; 0: the device tells nothing of it.
int latency_timer_ms(const std::string& device) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(device, error);
  if (error) return 0;
  std::ifstream in(std::filesystem::path("/sys/bus/usb-serial/devices") / real.filename() / "latency_timer");
  int ms = 0;
  return in >> ms ? ms : 0;
}

}  // namespace

TerminalPort::TerminalPort(const std::string& device, std::uint32_t baud)
    : device_(device), descriptor_(open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  if (!descriptor_ && errno == ENOENT)
    refuse_device(device, "is not there: is the adapter plugged in? `ls -l /dev/serial/by-id` shows those that are");
  if (!descriptor_ && errno == EACCES)
    refuse_device(device, "this user may not open it: add them to its group (`ls -l " + device +
                              "` names it, often dialout) with `sudo usermod -aG dialout $USER`, and log in again");
  if (!descriptor_) refuse_device(device, words_of(errno));
  if (isatty(descriptor_.number()) == 0) refuse_device(device, "is no serial port");
  if (flock(descriptor_.number(), LOCK_EX | LOCK_NB) != 0) refuse_device(device, "another program has it");
  set_baud(baud);
  ask_for_low_latency(descriptor_.number());
}

std::unique_ptr<SerialPort> open_port(const std::string& device, std::uint32_t baud, const InputProblem& place) {
  try {
    return std::make_unique<TerminalPort>(device, baud);
  } catch (const InputError& error) {
    throw InputError(place.with(error.problems().front().message));
  }
}

void TerminalPort::set_baud(std::uint32_t baud) {
  termios2 terms{};
  if (ioctl(descriptor_.number(), TCGETS2, &terms) != 0) refuse_device(device_, "is no serial port");
  terms.c_iflag = 0;
  terms.c_oflag = 0;
  terms.c_lflag = 0;
  terms.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
  terms.c_ispeed = terms.c_ospeed = baud;
  terms.c_cc[VMIN] = 0;
  terms.c_cc[VTIME] = 0;
  termios2 is{};
  if (ioctl(descriptor_.number(), TCSETS2, &terms) != 0 || ioctl(descriptor_.number(), TCGETS2, &is) != 0)
    refuse_device(device_, words_of(errno));
  // Three percent: more, and a byte's last bit is read wrong.
  if (is.c_ospeed < baud - baud / 33 || is.c_ospeed > baud + baud / 33)
    refuse_device(device_,
                  "cannot run at " + std::to_string(baud) + " baud, the nearest is " + std::to_string(is.c_ospeed));
}

bool TerminalPort::send(std::span<const std::uint8_t> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t sent = ::write(descriptor_.number(), bytes.data(), bytes.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

std::size_t TerminalPort::receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept {
  for (;;) {
    const ssize_t got = ::read(descriptor_.number(), into.data(), into.size());
    if (got > 0) return static_cast<std::size_t>(got);
    const std::int64_t left_ns = until_ns - now_ns();
    if (left_ns <= 0 || into.empty()) return 0;
    pollfd wanted{descriptor_.number(), POLLIN, 0};
    const timespec wait = timespec_of(left_ns);
    const int ready = ppoll(&wanted, 1, &wait, nullptr);
    if (ready < 0 && errno != EINTR) return 0;
    if (ready > 0 && (wanted.revents & POLLIN) == 0) {  // unplugged: it would be ready at once, forever
      const timespec rest = timespec_of(std::min<std::int64_t>(left_ns, 1'000'000));
      clock_nanosleep(CLOCK_MONOTONIC, 0, &rest, nullptr);
    }
  }
}

void TerminalPort::discard() noexcept { (void)ioctl(descriptor_.number(), TCFLSH, TCIFLUSH); }

void examine_serial_port(const std::string& name, const std::string& device,
                         std::vector<PlantType::Finding>& findings) {
  PlantType::Finding finding{.topic = "port " + name, .good = false, .is = device, .should = {}, .how = {}};
  struct stat is {};
  if (stat(device.c_str(), &is) != 0) {
    finding.is += ": " + words_of(errno);
    finding.should = "a serial port";
    finding.how = "plug the adapter in, and name it as `ls -l /dev/serial/by-id` shows it";
  } else if (!S_ISCHR(is.st_mode)) {
    finding.is += " is no device";
    finding.should = "a serial port";
    finding.how = "name the adapter as `ls -l /dev/serial/by-id` shows it";
  } else if (access(device.c_str(), R_OK | W_OK) != 0) {
    finding.is += ": this user may not open it";
    finding.should = "readable and writable";
    finding.how = "sudo usermod -aG dialout $USER, and log in again";
  } else {
    finding.good = true;
  }
  findings.push_back(finding);
  const int timer_ms = latency_timer_ms(device);
  if (timer_ms <= 0) return;
  findings.push_back({.topic = "latency " + name,
                      .good = timer_ms <= 1,
                      .is = "the USB adapter keeps bytes back for up to " + std::to_string(timer_ms) + " ms",
                      .should = "1 ms",
                      .how = "a rule for udev: ACTION==\"add\", SUBSYSTEM==\"usb-serial\", "
                             "ATTR{latency_timer}=\"1\""});
}

}  // namespace kadans
