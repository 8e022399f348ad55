#include "imu_world.h"

#include <algorithm>
#include <utility>

#include "kadans/model/kinematics.h"

namespace kadans::imu {
namespace {

constexpr std::uint32_t virtual_baud = 115'200;
constexpr std::int64_t found_before_ns = 100'000'000;  // the device is found before the time begins

}  // namespace

bool ImuLine::send(std::span<const std::uint8_t> bytes) noexcept {
  passed_.pass(bytes, now_);
  device_.receive(bytes, now_, virtual_baud);
  return true;
}

std::size_t ImuLine::receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept {
  if (fetched_ > 0) {
    std::copy_n(ready_.begin(), std::min(fetched_, into.size()), into.begin());
    return std::min(std::exchange(fetched_, 0), into.size());
  }
  for (;;) {
    device_.pass(now_);
    const std::size_t got = device_.take(into, now_);
    if (got > 0) passed_.pass(into.first(got), now_);
    if (got > 0 || now_ >= until_ns) return got;
    now_ = std::max(now_, std::min(until_ns, device_.due_ns()));
  }
}

void ImuLine::fetch() {
  device_.pass(now_);
  fetched_ = device_.take(ready_, now_);
}

class ImuWorld::Beside final : public Plant {
 public:
  explicit Beside(ImuWorld& world) noexcept : world_(world), drives_(world.robot_) {}
  void declare_signals(SignalTable& table) const override { drives_.declare_signals(table); }
  bool open(bool (*)() noexcept) override { return true; }  // it is open already
  void close() noexcept override { drives_.close(); }
  std::vector<PlantCount> link_counts() const override { return drives_.link_counts(); }
  void read(SensorFrame& sensors) noexcept override {
    drives_.read(sensors);
    world_.feel(sensors);
  }
  void write(const ActuationFrame& actuation) noexcept override { drives_.write(actuation); }

 private:
  ImuWorld& world_;
  Plant& drives_;
};

ImuWorld::ImuWorld(std::unique_ptr<World> robot, const SerialImuSettings& settings, const Quat& to_base,
                   const std::vector<EmulatedFault>& faults, std::uint64_t seed)
    : WorldAround(std::move(robot)), faults_(faults), to_base_(to_base), device_(device_of(settings), seed) {
  for (const EmulatedFault& fault : faults) check_imu_fault(fault);
  auto line = std::make_unique<ImuLine>(device_);
  line_ = line.get();
  line_->set(-found_before_ns);
  plant_ = std::make_unique<ImuPlant>(std::make_unique<Beside>(*this), settings, to_base, std::move(line),
                                      ImuPlant::Threads::none);
}

bool ImuWorld::open(bool (*give_up)() noexcept) {
  started_ = true;
  if (!robot_.open(give_up)) return false;
  SensorFrame sensors;
  robot_.read(sensors);
  feel(sensors);
  return plant_->open(give_up);
}

void ImuWorld::feel(const SensorFrame& sensors) noexcept {
  if (time_ns_ > 0) device_.pass(time_ns_);  // what was due until now it has measured
  device_.feels(rotate_inverse(to_base_, sensors.imu.angular_velocity_rad_s),
                rotate_inverse(to_base_, sensors.imu.acceleration_m_s2));
}

void ImuWorld::read(SensorFrame& sensors) noexcept {
  if (!started_) (void)open();
  line_->set(time_ns_);
  plant_->read(sensors);
}

void ImuWorld::step(std::int64_t dt_ns) {
  befall(device_, faults_, 1e-9 * static_cast<double>(time_ns_));
  world_.step(dt_ns);
  time_ns_ += dt_ns;
}

void ImuWorld::hash(StateHash& hash) const noexcept {
  WorldAround::hash(hash);
  hash.add(line_->passed());
}

}  // namespace kadans::imu
