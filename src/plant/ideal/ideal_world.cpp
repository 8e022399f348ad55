#include "kadans/plant/ideal_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace kadans {
namespace {

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument("ideal plant: " + what);
}

// What a drive that has no limits puts on a free inertia; its own loop is implicit in time.
double torque_Nm(const JointActuation& asked, double position_rad, double velocity_rad_s, double inertia_kg_m2,
                 double dt_s) noexcept {
  if (asked.mode == ActuationMode::effort) return asked.effort_Nm;
  if (asked.mode != ActuationMode::impedance) return 0;
  const double slope = asked.damping_Nms_per_rad + dt_s * asked.stiffness_Nm_per_rad;
  const double now_Nm = asked.stiffness_Nm_per_rad * (asked.position_rad - position_rad) - slope * velocity_rad_s +
                        asked.damping_Nms_per_rad * asked.velocity_rad_s + asked.effort_Nm;
  return now_Nm / (1 + slope * dt_s / inertia_kg_m2);
}

}  // namespace

IdealWorld::IdealWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed)
    : drives_(settings.drives, model.joints.size()), channels_(settings.channels, seed) {
  const std::size_t joints = model.joints.size();
  for (const Transmission& transmission : model.transmissions) {
    if (transmission.coupled()) couplings_.push_back(transmission);
  }
  require(joints <= max_joints, "at most " + std::to_string(max_joints) + " joints");
  require(settings.position_rad.size() == joints, "position_rad must have one entry a joint");
  require(settings.drives.empty() || settings.drives.size() == joints, "drives must have one entry a joint, or none");
  truth_.joint_count = static_cast<std::uint32_t>(joints);
  truth_.base = settings.base;
  for (std::size_t i = 0; i < joints; ++i) {
    const Joint& joint = model.joints[i];
    const bool limited = joint.type != JointType::continuous;
    const double rotor = settings.drives.empty() ? 0 : settings.drives[i].rotor_inertia_kg_m2;
    inertia_kg_m2_[i] = rotor > 0 ? rotor : 1;
    lower_rad_[i] = limited ? joint.lower_rad : -std::numeric_limits<double>::infinity();
    truth_.motor_torque_max_Nm[i] = std::numeric_limits<double>::infinity();
    upper_rad_[i] = limited ? joint.upper_rad : std::numeric_limits<double>::infinity();
    truth_.position_rad[i] = settings.position_rad[i];
    if (joint.mimic) mimics_.emplace_back(i, *joint.mimic);
  }
  model.lead_mimics({truth_.position_rad.data(), joints});
  channels_.sample(time_ns_);
}

void IdealWorld::read(SensorFrame& sensors) noexcept {
  sensors.time_ns = time_ns_;
  sensors.joint_count = truth_.joint_count;
  sensors.foot_count = 0;
  for (std::size_t i = 0; i < truth_.joint_count; ++i) {
    const double effort_Nm = truth_.drive_torque_Nm[i];
    sensors.joints[i] = {truth_.position_rad[i], truth_.position_rad[i], effort_Nm, sequence_ + 1};
  }
  drives_.fill(sensors);
  sensors.imu = {{0, 0, 0}, {0, 0, 9.81}, sequence_ + 1};
  sensors.supply_V = std::numeric_limits<double>::quiet_NaN();
  sensors.emergency = false;
  channels_.fill(sensors);
}

void IdealWorld::take(const ActuationFrame& actuation) noexcept {
  actuation_.joint_count = std::min(actuation.joint_count, truth_.joint_count);
  copy_first(actuation.drives, actuation_.joint_count, actuation_.drives);
  for (std::size_t i = 0; i < truth_.joint_count; ++i) {
    JointActuation& asked = actuation_.joints[i];
    asked = actuation.joints[i];
    if (i >= actuation_.joint_count || !is_finite(asked)) asked = {};
  }
}

void IdealWorld::write(const ActuationFrame& actuation) noexcept {
  take(actuation);
  for (const Transmission& coupling : couplings_) coupling.to_drives(actuation_);
  drives_.write(actuation_);
}

void IdealWorld::write_drives(const ActuationFrame& drives) noexcept {
  take(drives);
  drives_.write(actuation_);
}

void IdealWorld::move_drive(std::size_t i, double dt_s) noexcept {
  const JointActuation asked = drives_.enabled(i) ? actuation_.joints[i] : JointActuation{};
  double& position = truth_.position_rad[i];
  double& velocity = truth_.velocity_rad_s[i];
  truth_.motor_torque_Nm[i] = torque_Nm(asked, position, velocity, inertia_kg_m2_[i], dt_s);
  const double before = position;
  velocity += dt_s * truth_.motor_torque_Nm[i] / inertia_kg_m2_[i];
  if (asked.mode == ActuationMode::velocity) velocity = asked.velocity_rad_s;
  position = asked.mode == ActuationMode::position ? asked.position_rad : position + dt_s * velocity;
  if (asked.mode == ActuationMode::position) velocity = (position - before) / dt_s;
  if (drives_.braked(i)) {
    position = before;
    velocity = 0;
  }
}

// Between the joints' coordinates and those of their drives, there and back.
void IdealWorld::map_coupled(bool to_drives) noexcept {
  for (const Transmission& coupling : couplings_) {
    using T = Transmission;
    coupling.map(truth_.position_rad, to_drives ? &T::drive_position_rad : &T::joint_position_rad);
    coupling.map(truth_.velocity_rad_s, to_drives ? &T::drive_velocity_rad_s : &T::joint_velocity_rad_s);
    if (!to_drives) coupling.map(truth_.drive_torque_Nm, &T::joint_effort_Nm);
  }
}

void IdealWorld::step(std::int64_t dt_ns) {
  if (dt_ns <= 0) return;
  const double dt_s = static_cast<double>(dt_ns) * 1e-9;
  map_coupled(true);
  for (std::size_t i = 0; i < truth_.joint_count; ++i) move_drive(i, dt_s);
  truth_.drive_torque_Nm = truth_.motor_torque_Nm;
  map_coupled(false);
  for (std::size_t i = 0; i < truth_.joint_count; ++i) {
    const double inside = std::clamp(truth_.position_rad[i], lower_rad_[i], upper_rad_[i]);
    if (inside == truth_.position_rad[i]) continue;
    truth_.position_rad[i] = inside;
    truth_.velocity_rad_s[i] = 0;
  }
  for (const auto& [joint, mimic] : mimics_) {
    truth_.position_rad[joint] = mimic.multiplier * truth_.position_rad[mimic.joint] + mimic.offset;
    truth_.velocity_rad_s[joint] = mimic.multiplier * truth_.velocity_rad_s[mimic.joint];
  }
  drives_.step(dt_ns);
  time_ns_ += dt_ns;
  ++sequence_;
  channels_.sample(time_ns_);
}

void IdealWorld::hash(StateHash& hash) const noexcept {
  for (std::size_t i = 0; i < truth_.joint_count; ++i) {
    hash.add(truth_.position_rad[i]);
    hash.add(truth_.velocity_rad_s[i]);
  }
  drives_.hash(hash);
  hash.add(static_cast<std::uint64_t>(time_ns_));
}

}  // namespace kadans
