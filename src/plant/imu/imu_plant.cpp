#include "imu_plant.h"

#include <utility>

#include "kadans/model/kinematics.h"

namespace kadans::imu {
namespace {

constexpr std::int64_t look_ns = 20'000'000;  // how soon the thread sees that it shall end

constexpr NamedCount<ImuCounts> imu_counts[] = {
    {"imu_readings", &ImuCounts::readings, "readings of the IMU"},
    {"imu_lost", &ImuCounts::lost, "readings of the IMU that never came"},
    {"imu_corrupt", &ImuCounts::corrupt, "messages of the IMU with a wrong checksum or length"},
    {"imu_strange", &ImuCounts::strange, "readings that no IMU measures, or that were not asked for: not used"},
};

}  // namespace

ImuPlant::ImuPlant(std::unique_ptr<Plant> bus, SerialImuSettings settings, const Quat& to_base,
                   std::unique_ptr<SerialPort> port, Threads threads)
    : bus_(std::move(bus)),
      settings_(std::move(settings)),
      to_base_(to_base),
      port_(std::move(port)),
      threads_(threads) {}

ImuPlant::~ImuPlant() { close(); }

bool ImuPlant::open(bool (*give_up)() noexcept) {
  if (port_ == nullptr) port_ = open_port(settings_.device, settings_.baud, settings_.place);
  imu_ = std::make_unique<SerialImu>(settings_, std::move(port_));
  if (!imu_->open(give_up) || !bus_->open(give_up)) return false;
  news_.publish(imu_->news());
  if (threads_ == Threads::none) return true;
  thread_.start("imu", "the IMU's serial port", [this] {
    while (!thread_.asked_to_stop()) {
      imu_->receive(imu_->now_ns() + look_ns);
      news_.publish(imu_->news());
    }
  });
  return true;
}

void ImuPlant::close() noexcept {
  thread_.stop();
  bus_->close();
}

void ImuPlant::read(SensorFrame& sensors) noexcept {
  bus_->read(sensors);
  if (threads_ == Threads::none) {
    imu_->receive(imu_->now_ns());
    news_.publish(imu_->news());
  }
  const auto news = news_.read();
  sensors.imu = news->sample;
  sensors.imu.angular_velocity_rad_s = rotate(to_base_, news->sample.angular_velocity_rad_s);
  sensors.imu.acceleration_m_s2 = rotate(to_base_, news->sample.acceleration_m_s2);
  counts_ = news->counts;
  age_ms_ = 1e3 * seconds_between(news->sample.time_ns, sensors.time_ns);
}

std::vector<PlantCount> ImuPlant::link_counts() const {
  std::vector<PlantCount> counts = bus_->link_counts();
  for (const PlantCount& one : counts_of(imu_counts, counts_)) counts.push_back(one);
  return counts;
}

void ImuPlant::declare_signals(SignalTable& table) const {
  bus_->declare_signals(table);
  declare_counts(table, imu_counts, counts_);
  table.add({"plant.bus.imu_age_ms", "ms", "age of the IMU's newest reading"}, &age_ms_);
}

}  // namespace kadans::imu
