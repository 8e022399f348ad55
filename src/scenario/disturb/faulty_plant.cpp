#include "faulty_plant.h"

#include <algorithm>

namespace kadans {
namespace {

// The one value of a sensor that an error of some size is added to.
double& value_of(const SensorFault& fault, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::imu) return frame.imu.angular_velocity_rad_s[0];
  if (fault.place == SensorKind::channel) return frame.channels[fault.index].value;
  return fault.place == SensorKind::foot ? frame.feet[fault.index].force_N[0] : frame.joints[fault.index].position_rad;
}

// All that the sensor says is as it was in `from`, but for the sequence numbers.
void repeat(const SensorFault& fault, const SensorFrame& from, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::joint) frame.joints[fault.index].position_rad = from.joints[fault.index].position_rad;
  if (fault.place == SensorKind::foot) frame.feet[fault.index].force_N = from.feet[fault.index].force_N;
  if (fault.place == SensorKind::channel) frame.channels[fault.index].value = from.channels[fault.index].value;
  if (fault.place != SensorKind::imu) return;
  frame.imu.angular_velocity_rad_s = from.imu.angular_velocity_rad_s;
  frame.imu.acceleration_m_s2 = from.imu.acceleration_m_s2;
}

void silence(const SensorFault& fault, const SensorFrame& from, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::joint) frame.joints[fault.index] = from.joints[fault.index];
  if (fault.place == SensorKind::foot) frame.feet[fault.index] = from.feet[fault.index];
  if (fault.place == SensorKind::channel) frame.channels[fault.index] = from.channels[fault.index];
  if (fault.place == SensorKind::imu) frame.imu = from.imu;
}

// Of any kind of fault.
template <typename Fault>
bool is_now(const Fault& fault, std::int64_t time_ns) noexcept {
  return time_ns >= fault.from_ns && time_ns < fault.until_ns;
}

// What a drive that fails says of itself.
void tell(const ActuatorFault& fault, std::int64_t time_ns, JointSample& sample) noexcept {
  switch (fault.kind) {
    case ActuatorFaultKind::tripped:
      sample.drive = DriveState::fault;
      sample.code = static_cast<std::uint32_t>(fault.size);
      break;
    case ActuatorFaultKind::disabled:
      sample.drive = DriveState::ready;
      break;
    case ActuatorFaultKind::hot:
      sample.temperature_C = static_cast<float>(fault.size);
      break;
    case ActuatorFaultKind::old:
      sample.time_ns = time_ns - static_cast<std::int64_t>(1e9 * fault.size);
      break;
    default:
      break;
  }
}

}  // namespace

void FaultyPlant::read(SensorFrame& sensors) noexcept {
  const SensorFrame before = sensors;  // a silent sensor repeats what it said last, sequence number included
  robot_.read(sensors);
  time_ns_ = sensors.time_ns;
  for (Planned& planned : faults_) {
    const SensorFault& fault = planned.fault;
    if (!is_now(fault, sensors.time_ns)) continue;
    if (!planned.begun) planned.first = fault.kind == SensorFaultKind::silent ? before : sensors;
    spoil(planned, sensors);
    planned.begun = true;
  }
  for (const PlannedActuator& planned : actuator_faults_) {
    const ActuatorFault& fault = planned.fault;
    if (planned.is_now(sensors.time_ns)) tell(fault, sensors.time_ns, sensors.joints[fault.joint]);
  }
  for (const SupplyFault& fault : supply_faults_) {
    if (!is_now(fault, sensors.time_ns)) continue;
    if (fault.button) sensors.emergency = true;
    if (!fault.button) sensors.supply_V = fault.supply_V;
  }
}

void FaultyPlant::spoil(Planned& planned, SensorFrame& sensors) noexcept {
  const SensorFault& fault = planned.fault;
  double& value = value_of(fault, sensors);
  switch (fault.kind) {
    case SensorFaultKind::silent:
      silence(fault, planned.first, sensors);
      break;
    case SensorFaultKind::stuck:
      repeat(fault, planned.first, sensors);
      break;
    case SensorFaultKind::offset:
      value += fault.size;
      break;
    case SensorFaultKind::noise: {
      const double draw = random_.uniform(-1, 1);
      value += fault.size * (draw < 0 ? 0.5 * draw - 0.5 : 0.5 * draw + 0.5);
      break;
    }
    case SensorFaultKind::jump:
      if (!planned.begun) value += fault.size;
      break;
    case SensorFaultKind::not_finite:
      value = std::numeric_limits<double>::quiet_NaN();
      break;
  }
}

// A drive that has tripped is reset, then enabled.
void FaultyPlant::PlannedActuator::heed(const DriveRequest& request, std::int64_t time_ns) noexcept {
  if (!request.is_new(order_seen) || !is_now(time_ns)) return;
  if (fault.kind == ActuatorFaultKind::disabled && request.order == DriveOrder::enable) over = true;
  if (fault.kind == ActuatorFaultKind::tripped && request.order == DriveOrder::reset)
    fault.kind = ActuatorFaultKind::disabled;
}

void FaultyPlant::add(const ActuatorFault& fault) {
  if (fault.kind == ActuatorFaultKind::late && written_.empty()) written_.resize(late_ticks_max + 1);
  actuator_faults_.push_back({.fault = fault, .held = {}, .order_seen = asked_[fault.joint].number});
}

void FaultyPlant::spoil(PlannedActuator& planned, JointActuation& actuation) const noexcept {
  const ActuatorFault& fault = planned.fault;
  if (!planned.is_now(time_ns_)) {
    planned.held = actuation;
    return;
  }
  switch (fault.kind) {
    case ActuatorFaultKind::hot:
    case ActuatorFaultKind::old:
      break;
    case ActuatorFaultKind::dead:
    case ActuatorFaultKind::tripped:
    case ActuatorFaultKind::disabled:
      actuation = {};
      break;
    case ActuatorFaultKind::weak:
      actuation.effort_Nm *= fault.size;
      break;
    case ActuatorFaultKind::stuck:
      actuation = planned.held;
      break;
    case ActuatorFaultKind::offset:
      actuation.effort_Nm += fault.size;
      break;
    case ActuatorFaultKind::late: {
      const auto ticks = static_cast<std::size_t>(std::clamp(fault.size, 0.0, double{late_ticks_max}));
      actuation = written_[(newest_ + written_.size() - ticks) % written_.size()].joints[fault.joint];
      break;
    }
  }
}

void FaultyPlant::write(const ActuationFrame& actuation) noexcept {
  ActuationFrame spoiled = actuation;
  if (!written_.empty()) {
    newest_ = (newest_ + 1) % written_.size();
    written_[newest_] = actuation;
  }
  for (PlannedActuator& planned : actuator_faults_) {
    planned.heed(actuation.drives[planned.fault.joint], time_ns_);
    spoil(planned, spoiled.joints[planned.fault.joint]);
  }
  asked_ = actuation.drives;
  robot_.write(spoiled);
}

void FaultyPlant::hash(StateHash& hash) const noexcept {
  world_.hash(hash);
  for (const PlannedActuator& planned : actuator_faults_) hash.add(planned.held.effort_Nm);
}

}  // namespace kadans
