#include "drive_server.h"

#include <algorithm>
#include <chrono>
#include <utility>

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

void DriveServer::look(World& world) {
  if (in_session_) (void)end_session();  // of a world that was given up
  {
    const std::lock_guard lock(mutex_);
    drives().look(world.robot(0));
    look_true_ = true;
  }
  changed_.notify_all();
}

bool DriveServer::await(int milliseconds) noexcept {
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  std::unique_lock lock(mutex_);
  if (!changed_.wait_for(lock, std::chrono::milliseconds(milliseconds), [this] { return spoken_to_; })) return false;
  session_ = {};
  silent_ns_ = time_ns_ = 0;
  heard_ = heard();
  stepped_ = cycles();
  time_runs_ = tripped_ = false;
  return in_session_ = true;
}

// Who speaks first finds an answer at once: programs that ask once, as mesaflash does, wait for some milliseconds.
void DriveServer::serve(const std::stop_token& stop) noexcept {
  sched_param parameter{};
  parameter.sched_priority = bus_priority;
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);  // without the right it is a usual thread
  std::vector<pollfd> wanted = polled(descriptors());
  std::int64_t wake_ns = 0;
  while (!stop.stop_requested()) {
    const timespec wait = timespec_of(std::max<std::int64_t>(0, wake_ns - monotonic_ns()));  // look_ns at most
    const bool came = ppoll(wanted.data(), wanted.size(), &wait, nullptr) > 0;
    std::unique_lock lock(mutex_);
    if (!look_true_) {  // what came waits until the drives know where they stand
      (void)changed_.wait_for(lock, std::chrono::nanoseconds(look_ns));
      continue;
    }
    wake_ns = std::min(monotonic_ns() + look_ns, serve_bus(monotonic_ns()));
    if (!came || std::exchange(spoken_to_, true)) continue;
    lock.unlock();
    changed_.notify_all();
  }
}

bool DriveServer::end_session() noexcept {
  const std::lock_guard lock(mutex_);
  faults_.end(drives());
  drives().switch_power();
  in_session_ = spoken_to_ = look_true_ = false;
  return false;
}

void DriveServer::end() noexcept {
  thread_.request_stop();
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::vector<PlantCount> DriveServer::link_counts() const {
  const std::lock_guard lock(mutex_);
  return counts();
}

void DriveServer::plan_faults(const std::vector<EmulatedFault>& faults) { faults_.add(faults, drives()); }

// How many of the periods pass for the model and its drives.
std::uint32_t DriveServer::due(std::uint32_t periods) noexcept {
  const std::uint64_t cycles = this->cycles(), ahead = cycles - std::exchange(stepped_, cycles);
  if (!in_step_ || !time_runs_) return periods;  // while drives are set up, they have the clock's time
  return divisor_ * static_cast<std::uint32_t>(std::min(ahead, in_step_ahead_max));
}

bool DriveServer::beat(World& world, std::uint32_t periods) {
  std::uint64_t heard = 0;
  const std::int64_t silent_max_ns = in_step_ ? in_step_timeout_ns : session_over_ns;
  const std::int64_t beat_ns = static_cast<std::int64_t>(periods) * period_ns_;
  {
    const std::lock_guard lock(mutex_);
    if (time_runs_) faults_.happen(drives(), time_ns_);
    drives().look(world.robot(0));
    drives().drive(world.robot(0));
    periods = due(periods);
    drives().pass(static_cast<std::int64_t>(periods) * period_ns_);
    time_runs_ = time_runs_ || drives().any_torque();
    const bool tripped = drives().any_watchdog_tripped();
    if (tripped && !tripped_) ++session_.releases;
    tripped_ = tripped;
    heard = this->heard();
    session_.left = !drives().any_torque();
  }
  for (std::uint32_t i = 0; time_runs_ && i < periods; ++i) world.step(period_ns_);
  if (time_runs_) time_ns_ += static_cast<std::int64_t>(periods) * period_ns_;
  silent_ns_ = heard == heard_ ? silent_ns_ + beat_ns : 0;
  heard_ = heard;
  return silent_ns_ < silent_max_ns || end_session();
}

}  // namespace kadans
