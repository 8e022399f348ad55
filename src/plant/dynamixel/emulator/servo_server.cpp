#include "servo_server.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <system_error>

#include <asm/termbits.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "plant/dynamixel/serial_port.h"

namespace kadans::dynamixel {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t session_over_ns = 1'000'000'000;
constexpr int bus_priority = 85;              // servos answer whatever else this machine does
constexpr std::int64_t look_ns = 50'000'000;  // how soon the thread sees that it shall end

[[noreturn]] void no_terminal(const std::string& link, const std::string& why) {
  throw InputError({.file = "--listen", .message = link + ": " + why});
}

std::uint32_t baud_of(int terminal) noexcept {
  termios2 terms{};
  return ioctl(terminal, TCGETS2, &terms) == 0 ? terms.c_ospeed : 0;
}

}  // namespace

ServoServer::ServoServer(const DynamixelSettings& settings, const PlantSite& site, const std::string& listen)
    : listen_(listen), period_ns_(site.layout.period_ns), robot_(settings, site, 1) {
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

bool ServoServer::await(int milliseconds) noexcept {
  std::vector<pollfd> wanted;
  for (const int master : masters_) wanted.push_back({master, POLLIN, 0});
  if (poll(wanted.data(), wanted.size(), milliseconds) <= 0) return false;
  session_ = {};
  silent_ns_ = 0;
  heard_ = 0;
  for (std::size_t i = 0; i < robot_.bus_count(); ++i) heard_ += robot_.bus(i).instructions();
  in_session_ = true;
  time_runs_ = tripped_ = false;
  return true;
}

void ServoServer::serve() noexcept {
  sched_param parameter{};
  parameter.sched_priority = bus_priority;
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);  // without the right it is a usual thread
  std::vector<pollfd> wanted;
  for (const int master : masters_) wanted.push_back({master, POLLIN, 0});
  std::array<std::uint8_t, 4096> bytes;
  while (!stop_.load(std::memory_order_relaxed)) {
    std::int64_t wake_ns = monotonic_ns() + look_ns;
    {
      const std::lock_guard lock(mutex_);
      for (std::size_t i = 0; i < masters_.size(); ++i) {
        EmulatedBus& bus = robot_.bus(i);
        const ssize_t got = ::read(masters_[i], bytes.data(), bytes.size());
        if (got > 0) bus.receive({bytes.data(), static_cast<std::size_t>(got)}, monotonic_ns(), baud_of(masters_[i]));
        const std::size_t count = bus.take(bytes, monotonic_ns());
        if (count > 0) (void)!::write(masters_[i], bytes.data(), count);
        wake_ns = std::min(wake_ns, bus.due_ns());
      }
    }
    const std::int64_t left_ns = std::max<std::int64_t>(0, wake_ns - monotonic_ns());
    const timespec wait{.tv_sec = 0, .tv_nsec = std::min(left_ns, look_ns)};
    (void)ppoll(wanted.data(), wanted.size(), &wait, nullptr);
  }
}

bool ServoServer::end_session() noexcept {
  in_session_ = false;
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
  robot_.switch_power();
  return false;
}

bool ServoServer::beat(World& world, std::uint32_t periods) {
  std::uint64_t heard = 0;
  {
    const std::lock_guard lock(mutex_);
    robot_.look(world.robot(0));
    robot_.drive(world.robot(0));
    robot_.pass(static_cast<std::int64_t>(periods) * period_ns_);
    time_runs_ = time_runs_ || (thread_.joinable() && robot_.any_torque());
    const bool tripped = robot_.any_watchdog_tripped();
    if (tripped && !tripped_) ++session_.releases;
    tripped_ = tripped;
    for (std::size_t i = 0; i < robot_.bus_count(); ++i) heard += robot_.bus(i).instructions();
    session_.left = !robot_.any_torque();
  }
  if (!thread_.joinable()) {  // from now on the servos know where they stand
    stop_.store(false, std::memory_order_relaxed);
    thread_ = std::thread([this] { serve(); });
  }
  for (std::uint32_t i = 0; time_runs_ && i < periods; ++i) world.step(period_ns_);
  silent_ns_ = heard == heard_ ? silent_ns_ + static_cast<std::int64_t>(periods) * period_ns_ : 0;
  heard_ = heard;
  return silent_ns_ < session_over_ns || end_session();
}

std::vector<PlantCount> ServoServer::link_counts() const {
  std::uint64_t instructions = 0, not_understood = 0;
  for (const auto& bus : robot_.buses()) {
    instructions += bus->instructions();
    not_understood += bus->not_understood();
  }
  return {{"instructions", instructions}, {"not understood", not_understood}};
}

}  // namespace kadans::dynamixel
