#include "imu_server.h"

#include <algorithm>
#include <array>
#include <utility>

#include <poll.h>
#include <pthread.h>

#include "kadans/model/kinematics.h"
#include "signal/monotonic_clock.h"

namespace kadans::imu {
namespace {

constexpr int device_priority = 85;                  // it measures whatever else this machine does
constexpr std::int64_t device_look_ns = 50'000'000;  // how soon the thread sees that it shall end

}  // namespace

ImuServer::ImuServer(std::unique_ptr<PlantEmulator> drives, const SerialImuSettings& settings, const Quat& to_base,
                     const std::string& link)
    : drives_(std::move(drives)),
      to_base_(to_base),
      terminal_(link, "--imu"),
      device_(device_of(settings), 1),
      thread_([this](const std::stop_token& stop) { serve(stop); }) {}

void ImuServer::serve(const std::stop_token& stop) noexcept {
  sched_param parameter{};
  parameter.sched_priority = device_priority;
  (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);  // without the right it is a usual thread
  pollfd wanted{terminal_.descriptor(), POLLIN, 0};
  std::array<std::uint8_t, 1024> bytes;
  while (!stop.stop_requested()) {
    const std::int64_t now_ns = monotonic_ns();
    std::int64_t wake_ns = now_ns + device_look_ns;
    {
      const std::lock_guard lock(mutex_);
      const std::size_t got = terminal_.read(bytes);
      if (got > 0) device_.receive({bytes.data(), got}, now_ns, terminal_.baud());
      device_.pass(now_ns);
      const std::size_t count = device_.take(bytes, now_ns);
      if (count > 0) terminal_.write({bytes.data(), count});
      wake_ns = std::min(wake_ns, device_.due_ns());
    }
    const timespec wait = timespec_of(std::max<std::int64_t>(0, wake_ns - monotonic_ns()));
    (void)ppoll(&wanted, 1, &wait, nullptr);
  }
}

void ImuServer::plan_faults(const std::vector<EmulatedFault>& faults) {
  for (const EmulatedFault& fault : faults) {
    if (fault.of != "imu") {
      drives_->plan_faults({fault});
      continue;
    }
    check_imu_fault(fault);
    faults_.push_back(fault);
  }
}

bool ImuServer::beat(World& world, std::uint32_t periods) {
  const bool on = drives_->beat(world, periods);
  SensorFrame sensors;
  world.robot(0).read(sensors);
  const std::lock_guard lock(mutex_);
  befall(device_, faults_, 1e-9 * static_cast<double>(sensors.time_ns));
  device_.feels(rotate_inverse(to_base_, sensors.imu.angular_velocity_rad_s),
                rotate_inverse(to_base_, sensors.imu.acceleration_m_s2));
  return on;
}

std::vector<PlantCount> ImuServer::link_counts() const {
  std::vector<PlantCount> counts = drives_->link_counts();
  const std::lock_guard lock(mutex_);
  counts.push_back({"imu messages", device_.understood()});
  return counts;
}

}  // namespace kadans::imu
