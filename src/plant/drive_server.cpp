#include "drive_server.h"

#include <algorithm>
#include <stdexcept>

#include <poll.h>
#include <pthread.h>

#include "signal/monotonic_clock.h"
#include "signal/nearest_name.h"

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

void check_fault(const EmulatedFault& fault, std::span<const EmulatedFaultKind> kinds,
                 const std::vector<std::string>& drives, const std::vector<std::string>& lines) {
  using Of = EmulatedFaultKind::Of;
  const auto fail = [](const std::string& why) { throw std::invalid_argument(why); };
  const auto kind = std::ranges::find_if(kinds, [&](const EmulatedFaultKind& one) { return one.name == fault.kind; });
  if (kind == kinds.end()) {
    std::string all;
    for (const EmulatedFaultKind& one : kinds) all += (all.empty() ? "" : ", ") + std::string(one.name);
    fail("no fault '" + fault.kind + "' of this bus; there are " + all);
  }
  const std::vector<std::string>& names = kind->of == Of::drive ? drives : lines;
  const bool known = std::ranges::find(names, fault.of) != names.end();
  if (kind->of == Of::nothing && !fault.of.empty()) fail(fault.kind + " is of nothing, not of '" + fault.of + "'");
  if (kind->of == Of::drive && fault.of.empty()) fail(fault.kind + " needs a drive, such as " + names.front());
  if (!fault.of.empty() && kind->of != Of::nothing && !known)
    fail((kind->of == Of::drive ? "no drive '" : "no port or board '") + fault.of + "'" +
         did_you_mean(fault.of, names));
  const std::string size = kind->size;
  if (size.empty() && fault.size != 0) fail(fault.kind + " has no size");
  if (!size.empty() && fault.size == 0) fail(fault.kind + " needs a size: " + size);
  if (size.starts_with("share") && !(fault.size > 0 && fault.size <= 1)) fail(fault.kind + ": a share is 0..1");
}

bool DriveServer::await(int milliseconds) noexcept {
  std::vector<pollfd> wanted = polled(descriptors());
  if (poll(wanted.data(), wanted.size(), milliseconds) <= 0) return false;
  session_ = {};
  silent_ns_ = time_ns_ = 0;
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
  for (Planned& fault : faults_) {
    if (fault.begun && !fault.ended) drives().befall(fault.is, false);
    fault.begun = fault.ended = false;
  }
  drives().switch_power();
  return false;
}

void DriveServer::plan_faults(const std::vector<EmulatedFault>& faults) {
  for (const EmulatedFault& fault : faults) {
    drives().check(fault);
    faults_.push_back({.is = fault});
  }
}

void DriveServer::let_faults_happen() noexcept {
  const double time_s = 1e-9 * static_cast<double>(time_ns_);
  for (Planned& fault : faults_) {
    if (!fault.begun && time_s >= fault.is.from_s) drives().befall(fault.is, fault.begun = true);
    if (!fault.begun || fault.ended || time_s < fault.is.until_s) continue;
    fault.ended = true;
    drives().befall(fault.is, false);
  }
}

bool DriveServer::beat(World& world, std::uint32_t periods) {
  std::uint64_t heard = 0;
  {
    const std::lock_guard lock(mutex_);
    if (time_runs_) let_faults_happen();
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
  if (time_runs_) time_ns_ += static_cast<std::int64_t>(periods) * period_ns_;
  silent_ns_ = heard == heard_ ? silent_ns_ + static_cast<std::int64_t>(periods) * period_ns_ : 0;
  heard_ = heard;
  return silent_ns_ < session_over_ns || end_session();
}

}  // namespace kadans
