#include "kadans/model/transmission.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kadans {
namespace {

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument(what);
}

Transmission::Pair pair_of(const std::vector<double>& given, std::size_t count, double otherwise, const char* name) {
  require(given.empty() || given.size() == count,
          std::string(name) + " must have " + std::to_string(count) + (count == 1 ? " number" : " numbers"));
  Transmission::Pair pair{otherwise, otherwise};
  for (std::size_t i = 0; i < given.size(); ++i) pair[i] = given[i];
  return pair;
}

Transmission::Pair reductions(const std::vector<double>& given, std::size_t count, const char* name) {
  const Transmission::Pair n = pair_of(given, count, 1, name);
  for (const double ratio : n) {
    require(std::abs(ratio) >= 1e-6 && std::abs(ratio) <= 1e6,
            std::string(name) + " must be 1e-6..1e6 or -1e6..-1e-6: with 0 a drive would move no joint");
  }
  return n;
}

}  // namespace

Transmission::Transmission(const Settings& s) : joints_(s.joints), drives_(s.drives) {
  const std::size_t count = s.kind == Kind::simple ? 1 : 2;
  require(joints_.size() == count, count == 1 ? "a simple transmission has 1 joint" : "a coupling has 2 joints");
  require(drives_.empty() || drives_.size() == count, "drives must have one name a joint");
  require(count == 1 || joints_[0] != joints_[1], "a coupling needs two different joints");
  require(drives_.size() < 2 || drives_[0] != drives_[1], "the two drives need different names");
  const Pair na = reductions(s.actuator_reduction, count, "actuator_reduction");
  const Pair nj = reductions(s.joint_reduction, count, "joint_reduction");
  offset_rad_ = pair_of(s.joint_offset_rad, count, 0, "joint_offset_rad");
  require(std::isfinite(offset_rad_[0]) && std::isfinite(offset_rad_[1]), "joint_offset_rad must be finite");
  if (s.kind == Kind::differential) {
    ratio_ = {{{na[0] * nj[0], na[0] * nj[1]}, {na[1] * nj[0], -na[1] * nj[1]}}};
    inverse_ = {{{0.5 / ratio_[0][0], 0.5 / ratio_[1][0]}, {0.5 / ratio_[0][1], 0.5 / ratio_[1][1]}}};
  } else {
    const bool linkage = s.kind == Kind::four_bar_linkage;
    ratio_ = {{{na[0] * nj[0], 0}, {linkage ? na[1] : 0, na[1] * nj[1]}}};
    inverse_ = {{{1 / ratio_[0][0], 0}, {-ratio_[1][0] / (ratio_[0][0] * ratio_[1][1]), 1 / ratio_[1][1]}}};
  }
}

Transmission::Pair Transmission::drive_position_rad(const Pair& joint_rad) const noexcept {
  return times(ratio_, {joint_rad[0] - offset_rad_[0], joint_rad[1] - offset_rad_[1]});
}

Transmission::Pair Transmission::joint_position_rad(const Pair& drive_rad) const noexcept {
  const Pair x = times(inverse_, drive_rad);
  return {x[0] + offset_rad_[0], x[1] + offset_rad_[1]};
}

void Transmission::to_drives(ActuationFrame& frame) const noexcept {
  std::array<JointActuation, 2> asked;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i] < frame.joint_count) asked[i] = frame.joints[joints_[i]];
  }
  ActuationMode mode = asked[0].mode;
  if (coupled() && asked[1].mode != mode) mode = ActuationMode::effort;
  Pair effort_Nm, position_rad, velocity_rad_s;
  for (std::size_t i = 0; i < 2; ++i) {
    effort_Nm[i] = asked[i].mode == ActuationMode::off ? 0 : asked[i].effort_Nm;
    position_rad[i] = asked[i].position_rad;
    velocity_rad_s[i] = asked[i].velocity_rad_s;
  }
  effort_Nm = drive_effort_Nm(effort_Nm);
  position_rad = drive_position_rad(position_rad);
  velocity_rad_s = drive_velocity_rad_s(velocity_rad_s);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i] >= frame.joint_count) continue;
    JointActuation drive{
        .effort_Nm = effort_Nm[i], .position_rad = position_rad[i], .velocity_rad_s = velocity_rad_s[i], .mode = mode};
    for (std::size_t j = 0; j < joints_.size(); ++j) {  // the diagonal of C^-T K C^-1
      const double share = inverse_[j][i] * inverse_[j][i];
      drive.stiffness_Nm_per_rad += share * asked[j].stiffness_Nm_per_rad;
      drive.damping_Nms_per_rad += share * asked[j].damping_Nms_per_rad;
    }
    frame.joints[joints_[i]] = drive;
  }
}

template <typename Map>
void Transmission::map(SensorFrame& frame, double JointSample::*value, Map&& mapped) const noexcept {
  double &first = frame.joints[joints_[0]].*value, &second = frame.joints[joints_[coupled() ? 1 : 0]].*value;
  const Pair values = mapped(Pair{first, second});
  second = values[1];  // of a simple one overwritten
  first = values[0];
}

void Transmission::to_joints(SensorFrame& frame, Side side) const noexcept {
  const auto position = [&](const Pair& drives) { return joint_position_rad(drives); };
  if (side == Side::both) map(frame, &JointSample::position_rad, position);
  map(frame, &JointSample::motor_position_rad, position);
  map(frame, &JointSample::motor_effort_Nm, [&](const Pair& drives) { return joint_effort_Nm(drives); });
}

void Transmission::to_drives(SensorFrame& frame, Side side) const noexcept {
  const auto position = [&](const Pair& joints) { return drive_position_rad(joints); };
  if (side == Side::both) map(frame, &JointSample::position_rad, position);
  map(frame, &JointSample::motor_position_rad, position);
  map(frame, &JointSample::motor_effort_Nm, [&](const Pair& joints) { return drive_effort_Nm(joints); });
}

std::vector<std::string> drive_names(std::vector<std::string> joints, std::span<const Transmission> transmissions) {
  for (const Transmission& transmission : transmissions) {
    for (std::size_t i = 0; i < transmission.drives().size(); ++i)
      joints[transmission.joints()[i]] = transmission.drives()[i];
  }
  return joints;
}

void drives_to_joints(std::span<const Transmission> transmissions, SensorFrame& sensors) noexcept {
  for (const Transmission& transmission : transmissions) {
    const std::vector<std::size_t>& joints = transmission.joints();
    JointSample &first = sensors.joints[joints[0]], &second = sensors.joints[joints[transmission.coupled() ? 1 : 0]];
    transmission.to_joints(sensors, Transmission::Side::both);
    first.time_ns = second.time_ns = std::min(first.time_ns, second.time_ns);
    first.sequence = second.sequence = std::min(first.sequence, second.sequence);
  }
}

}  // namespace kadans
