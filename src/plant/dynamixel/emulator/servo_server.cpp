#include "servo_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>

#include <asm/termbits.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans::dynamixel {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void no_terminal(const std::string& link, const std::string& why) {
  throw InputError({.file = "--listen", .message = link + ": " + why});
}

std::uint32_t baud_of(int terminal) noexcept {
  termios2 terms{};
  return ioctl(terminal, TCGETS2, &terms) == 0 ? terms.c_ospeed : 0;
}

}  // namespace

ServoServer::ServoServer(const DynamixelSettings& settings, const PlantSite& site, const std::string& listen)
    : DriveServer(site.layout.period_ns), listen_(listen), robot_(settings, site, 1) {
  try {
    for (const PortSettings& port : settings.ports)
      open_terminal(settings.ports.size() == 1 ? listen : listen + "-" + port.name);
  } catch (...) {
    for (const std::string& link : links_) (void)unlink(link.c_str());
    throw;
  }
}

void ServoServer::open_terminal(const std::string& link) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0)
    no_terminal(link, "no pseudo-terminal: " + std::system_category().message(errno));
  masters_.push_back(master);
  char name[64];
  if (ptsname_r(master, name, sizeof name) != 0) no_terminal(link, "the pseudo-terminal has no name");
  const int slave = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios2 terms{};
  if (slave < 0 || ioctl(slave, TCGETS2, &terms) != 0) no_terminal(link, "the pseudo-terminal does not open");
  slaves_.push_back(slave);
  terms.c_iflag = terms.c_oflag = terms.c_lflag = 0;
  (void)ioctl(slave, TCSETS2, &terms);
  std::error_code error;
  if (fs::is_symlink(link, error)) fs::remove(link, error);  // of an emulator that was killed
  fs::create_symlink(name, link, error);
  if (error) no_terminal(link, "no link can be made there: " + error.message());
  links_.push_back(link);
}

ServoServer::~ServoServer() {
  (void)end_session();
  for (const std::string& link : links_) (void)unlink(link.c_str());
  for (const int one : slaves_) close(one);
  for (const int one : masters_) close(one);
}

std::int64_t ServoServer::serve_bus(std::int64_t now_ns) noexcept {
  std::array<std::uint8_t, 4096> bytes;
  std::int64_t wake_ns = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < masters_.size(); ++i) {
    EmulatedBus& bus = robot_.bus(i);
    const ssize_t got = ::read(masters_[i], bytes.data(), bytes.size());
    if (got > 0) bus.receive({bytes.data(), static_cast<std::size_t>(got)}, now_ns, baud_of(masters_[i]));
    const std::size_t count = bus.take(bytes, now_ns);
    if (count > 0) (void)!::write(masters_[i], bytes.data(), count);
    wake_ns = std::min(wake_ns, bus.due_ns());
  }
  return wake_ns;
}

std::uint64_t ServoServer::heard() const noexcept {
  std::uint64_t heard = 0;
  for (const auto& bus : robot_.buses()) heard += bus->instructions();
  return heard;
}

std::vector<PlantCount> ServoServer::link_counts() const {
  std::uint64_t not_understood = 0;
  for (const auto& bus : robot_.buses()) not_understood += bus->not_understood();
  return {{"instructions", heard()}, {"not understood", not_understood}};
}

}  // namespace kadans::dynamixel
