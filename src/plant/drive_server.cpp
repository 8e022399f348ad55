#include "drive_server.h"

#include <algorithm>

#include <poll.h>
#include <pthread.h>

#include "signal/monotonic_clock.h"

namespace kadans {
namespace {

constexpr std::int64_t session_over_ns = 1'000'000'000;
constexpr int bus_priority = 85;              // drives answer whatever else this machine does
constexpr std::int64_t look_ns = 50'000'000;  // how soon the thread sees that it shall end

std::vector<pollfd> polled(const std::vector<int>& descriptors) {
  std::vector<pollfd> wanted;
  for (const int one : descriptors) wanted.push_back({one, POLLIN, 0});
  return wanted;
}

}  // namespace

bool DriveServer::await(int milliseconds) noexcept {
  std::vector<pollfd> wanted = polled(descriptors());
  if (poll(wanted.data(), wanted.size(), milliseconds) <= 0) return false;
  session_ = {};
  silent_ns_ = 0;
  heard_ = heard();
  time_runs_ = tripped_ = false;
  return true;
}

void DriveServer::serve() noexcept {
  sched_param parameter{};
  parameter.sched_priority = bus_priority;
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);  // without the right it is a usual thread
  std::vector<pollfd> wanted = polled(descriptors());
  while (!stop_.load(std::memory_order_relaxed)) {
    std::int64_t wake_ns = monotonic_ns() + look_ns;
    {
      const std::lock_guard lock(mutex_);
      wake_ns = std::min(wake_ns, serve_bus(monotonic_ns()));
    }
    const std::int64_t left_ns = std::max<std::int64_t>(0, wake_ns - monotonic_ns());
    const timespec wait{.tv_sec = 0, .tv_nsec = std::min(left_ns, look_ns)};
    (void)ppoll(wanted.data(), wanted.size(), &wait, nullptr);
  }
}

bool DriveServer::end_session() noexcept {
  stop_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
  drives().switch_power();
  return false;
}

bool DriveServer::beat(World& world, std::uint32_t periods) {
  std::uint64_t heard = 0;
  {
    const std::lock_guard lock(mutex_);
    drives().look(world.robot(0));
    drives().drive(world.robot(0));
    drives().pass(static_cast<std::int64_t>(periods) * period_ns_);
    time_runs_ = time_runs_ || (thread_.joinable() && drives().any_torque());
    const bool tripped = drives().any_watchdog_tripped();
    if (tripped && !tripped_) ++session_.releases;
    tripped_ = tripped;
    heard = this->heard();
    session_.left = !drives().any_torque();
  }
  if (!thread_.joinable()) {  // from now on the drives know where they stand
    stop_.store(false, std::memory_order_relaxed);
    thread_ = std::thread([this] { serve(); });
  }
  for (std::uint32_t i = 0; time_runs_ && i < periods; ++i) world.step(period_ns_);
  silent_ns_ = heard == heard_ ? silent_ns_ + static_cast<std::int64_t>(periods) * period_ns_ : 0;
  heard_ = heard;
  return silent_ns_ < session_over_ns || end_session();
}

}  // namespace kadans
