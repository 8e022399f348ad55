#include "imu_plant.h"

#include <csignal>
#include <utility>

#include "kadans/model/kinematics.h"
#include "kadans/signal/input_error.h"

namespace kadans::imu {
namespace {

constexpr int line_priority = 80;  // below the control thread's
constexpr std::size_t line_stack_bytes = std::size_t{256} * 1024;
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
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, line_stack_bytes);
  runs_ = pthread_create(&thread_, &attributes, enter, this) == 0;
  pthread_attr_destroy(&attributes);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (!runs_) throw InputError({.message = "the system gives no thread to the IMU's serial port"});
  sched_param parameter{};
  parameter.sched_priority = line_priority;
  (void)pthread_setschedparam(thread_, SCHED_FIFO, &parameter);  // without the right it is a usual thread
  pthread_setname_np(thread_, "imu");
  return true;
}

void* ImuPlant::enter(void* self) {
  ImuPlant& plant = *static_cast<ImuPlant*>(self);
  while (!plant.stop_.load(std::memory_order_relaxed)) {
    plant.imu_->receive(plant.imu_->now_ns() + look_ns);
    plant.news_.publish(plant.imu_->news());
  }
  return nullptr;
}

void ImuPlant::close() noexcept {
  stop_.store(true, std::memory_order_relaxed);
  if (std::exchange(runs_, false)) pthread_join(thread_, nullptr);
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
