
#include "estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "signal/status_fields.h"

namespace kadans {
namespace {

constexpr double imu_foresight_s = 0.05;  // at most so long the base is thought to turn on as the gyro last said

// Whether the sensor has a new reading, counting the ticks without.
bool is_new(std::uint32_t sequence, std::uint32_t& last_sequence, bool look, SensorState& health) noexcept {
  if (look && sequence != last_sequence) {
    last_sequence = sequence;
    health.silent_ticks = 0;
    return true;
  }
  if (health.silent_ticks < std::numeric_limits<std::uint32_t>::max()) ++health.silent_ticks;
  return false;
}

[[noreturn]] void reject(const std::string& what) { throw std::invalid_argument("estimate: " + what); }

// The vector's value for a joint; `otherwise` when the vector is empty.
template <typename T>
T of_joint(const std::vector<T>& values, std::size_t joint, T otherwise) {
  return values.empty() ? otherwise : values[joint];
}

template <typename T>
void check_size(const std::vector<T>& values, const char* key, const RobotModel& model) {
  if (!values.empty() && values.size() != model.joints.size())
    reject(std::string(key) + " has " + std::to_string(values.size()) + " values, the robot " +
           std::to_string(model.joints.size()) + " joints");
}

OrientationFilter::Config orientation_config(const EstimateSettings& settings) {
  return {.accelerometer_gain_per_s = settings.accelerometer_gain_per_s,
          .gyro_bias_gain_per_s2 = settings.gyro_bias_gain_per_s2,
          .gravity_tolerance = settings.gravity_tolerance,
          .gyro_bias_max_rad_s = settings.gyro_bias_max_rad_s};
}

// Built with the name of the setting's owner before what the part itself says.
template <typename Part>
Part make(const typename Part::Config& config, const std::string& owner) {
  try {
    return Part(config);
  } catch (const std::invalid_argument& error) {
    reject(owner + ": " + error.what());
  }
}

}  // namespace

void Estimator::update(const SensorFrame& sensors, double dt_s, std::uint64_t tick, JointStates& joints,
                       RobotStatus& status) noexcept {
  if (!(dt_s > 0 && std::isfinite(dt_s))) dt_s = dt_s_;
  joints.count = health_.joint_count;
  for (std::size_t i = 0; i < joints.count; ++i) {
    const std::uint32_t period_ticks = health_.joints[i].period_ticks;
    const bool due = period_ticks == 1 || !started_ || tick % period_ticks == 0;
    update_joint(i, sensors.joints[i], due && i < sensors.joint_count, dt_s);
    const JointState& state = joints_[i].state;
    joints.joints[i] = {state.position_rad, state.velocity_rad_s, state.effort_Nm};
  }
  for (const ElasticPair& pair : pairs_) update_pair(pair, sensors, joints);
  const Axes base = update_base(sensors.imu, sensors.time_ns, dt_s, status.base);
  status.foot_count = health_.foot_count;
  for (std::size_t i = 0; i < feet_.size(); ++i) update_foot(i, sensors.feet[i], status.feet[i]);
  update_support(joints, base, dt_s, status);
  update_channels(sensors, status);
  started_ = true;
}

inline void Estimator::update_joint(std::size_t joint, const JointSample& sample, bool look, double dt_s) noexcept {
  JointTrack& track = joints_[joint];
  SensorState& health = health_.joints[joint];
  track.elapsed_s += dt_s;
  if (!is_new(sample.sequence, track.last_sequence, look, health)) return;

  // A bus that says when each reading was taken knows better than the tick.
  const bool timed = track.last_time_ns != 0 && sample.time_ns > track.last_time_ns;
  const double elapsed_s = timed ? seconds_between(track.last_time_ns, sample.time_ns) : track.elapsed_s;
  const bool position_ok = std::isfinite(sample.position_rad);
  const bool effort_ok = std::isfinite(sample.motor_effort_Nm);
  health.finite = position_ok && effort_ok && std::isfinite(sample.motor_position_rad);
  if (position_ok) {
    track.state.position_rad = sample.position_rad;
    track.state.velocity_rad_s = track.velocity.update(sample.position_rad, elapsed_s);
    track.elapsed_s = 0;
    track.last_time_ns = sample.time_ns;
  }
  if (track.spring_Nm_per_rad > 0) {
    const double deflection_rad = sample.motor_position_rad - sample.position_rad;
    if (std::isfinite(deflection_rad)) track.state.effort_Nm = track.spring_Nm_per_rad * deflection_rad;
  } else if (effort_ok && !track.paired) {
    track.state.effort_Nm = sample.motor_effort_Nm;
  }
}

// Each drive's torque, by its spring where it has one, as torques of the joints.
void Estimator::update_pair(const ElasticPair& pair, const SensorFrame& sensors, JointStates& joints) noexcept {
  const Transmission& coupling = pair.transmission;
  const auto read_now = [&](std::size_t joint) { return joints_[joint].elapsed_s == 0; };
  if (std::ranges::none_of(coupling.joints(), read_now)) return;
  Transmission::Pair bent_rad, effort_Nm;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t joint = coupling.joints()[i];
    if (joint >= sensors.joint_count) return;
    const JointSample& sample = sensors.joints[joint];
    bent_rad[i] = sample.motor_position_rad - sample.position_rad;
    effort_Nm[i] = sample.motor_effort_Nm;
  }
  bent_rad = coupling.drive_velocity_rad_s(bent_rad);  // by the same matrix as velocities
  effort_Nm = coupling.drive_effort_Nm(effort_Nm);
  for (std::size_t i = 0; i < 2; ++i) {
    if (pair.spring_Nm_per_rad[i] > 0) effort_Nm[i] = pair.spring_Nm_per_rad[i] * bent_rad[i];
  }
  effort_Nm = coupling.joint_effort_Nm(effort_Nm);
  if (!std::isfinite(effort_Nm[0] + effort_Nm[1])) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t joint = coupling.joints()[i];
    joints.joints[joint].effort_Nm = joints_[joint].state.effort_Nm = effort_Nm[i];
  }
}

Axes Estimator::update_base(const ImuSample& sample, std::int64_t now_ns, double dt_s, BaseStatus& base) noexcept {
  imu_elapsed_s_ += dt_s;
  if (is_new(sample.sequence, last_imu_sequence_, true, health_.imu)) {
    const bool gyro_ok = is_finite(sample.angular_velocity_rad_s);
    health_.imu.finite = gyro_ok && is_finite(sample.acceleration_m_s2);
    const bool timed = sample.time_ns > last_imu_time_ns_ && last_imu_time_ns_ != 0;
    orientation_.update(sample.angular_velocity_rad_s, sample.acceleration_m_s2,
                        timed ? seconds_between(last_imu_time_ns_, sample.time_ns) : imu_elapsed_s_);
    if (gyro_ok) {
      imu_elapsed_s_ = 0;
      last_imu_time_ns_ = sample.time_ns;
    }
  }
  const OrientationFilter::State& state = orientation_.state();
  const double age_s = last_imu_time_ns_ != 0 ? seconds_between(last_imu_time_ns_, now_ns) : 0;
  base.orientation = age_s > 0 ? orientation_.orientation_after(std::min(age_s, imu_foresight_s)) : state.orientation;
  base.angular_velocity_rad_s = state.angular_velocity_rad_s;
  const Axes axes = axes_of(base.orientation);
  const Attitude angles = attitude(axes);
  base.roll_rad = angles.roll_rad;
  base.pitch_rad = angles.pitch_rad;
  base.yaw_rad = angles.yaw_rad;
  base.tilt_rad = angles.tilt_rad;
  base.posture = posture_of({axes.x[2], axes.y[2], axes.z[2]});
  return axes;
}

void Estimator::update_foot(std::size_t foot, const FootSample& sample, FootStatus& status) noexcept {
  FootTrack& track = feet_[foot];
  SensorState& health = health_.feet[foot];
  if (is_new(sample.sequence, track.last_sequence, true, health)) {
    health.finite = true;
    for (std::size_t s = 0; s < sensors_per_foot; ++s) {
      if (std::isfinite(sample.force_N[s]))
        track.force_N[s] = sample.force_N[s];
      else
        health.finite = false;
    }
    track.detector.update(track.force_N);
  }
  const ContactDetector::State& state = track.detector.state();
  status = {state.contact, state.force_N, state.cop_m[0], state.cop_m[1]};
}

void Estimator::update_channels(const SensorFrame& sensors, RobotStatus& status) noexcept {
  status.channel_count = health_.channel_count;
  for (std::size_t i = 0; i < health_.channel_count; ++i) {
    SensorState& health = health_.channels[i];
    const ChannelSample& sample = sensors.channels[i];
    if (is_new(sample.sequence, last_channel_sequences_[i], i < sensors.channel_count, health)) {
      health.finite = std::isfinite(sample.value);
      if (health.finite) channels_[i] = sample.value;
    }
    status.channels[i] = channels_[i];
  }
}

// The legs that bear: how high the base is, and where the ground bears the robot.
void Estimator::update_support(const JointStates& joints, const Axes& base, double dt_s, RobotStatus& status) noexcept {
  const double level = std::sqrt(base.x[0] * base.x[0] + base.x[1] * base.x[1]);
  if (level > 0.1) {  // else the base's x points up or down and says little of a heading
    heading_x_ = base.x[0] / level;
    heading_y_ = base.x[1] / level;
  }
  double lowest_m = std::numeric_limits<double>::infinity();
  double moment_x_Nm = 0, moment_y_Nm = 0;
  Odometry::Way way;
  support_.force_N = 0;
  for (FootTrack& foot : feet_) {
    const ContactDetector::State& contact = foot.detector.state();
    const bool bore = std::exchange(foot.bore, contact.contact);
    if (!contact.contact) continue;
    const Vec3 was_m = foot.leg.point(contact.cop_m), toes_were = foot.leg.axes().x;
    foot.leg.update(joints, base);
    for (const Vec3& corner_m : foot.detector.config().sensors_m)
      lowest_m = std::min(lowest_m, foot.leg.point(corner_m)[2]);
    const Vec3 cop_m = foot.leg.point(contact.cop_m);
    if (bore) {
      const Vec3& toes = foot.leg.axes().x;
      way.add(contact.force_N, was_m[0] - cop_m[0], was_m[1] - cop_m[1],
              toes_were[0] * toes[1] - toes_were[1] * toes[0]);
    }
    moment_x_Nm += contact.force_N * cop_m[0];
    moment_y_Nm += contact.force_N * cop_m[1];
    support_.force_N += contact.force_N;
  }
  if (support_.force_N > 0) {
    const double x_m = moment_x_Nm / support_.force_N, y_m = moment_y_Nm / support_.force_N;
    support_.cop_x_m = heading_x_ * x_m + heading_y_ * y_m;
    support_.cop_y_m = heading_x_ * y_m - heading_y_ * x_m;
    height_m_ = -lowest_m;
  }
  status.base.height_m = height_m_;
  status.support = support_;
  odometry_.update(way, way.feet == feet_.size(), {heading_x_, heading_y_}, status.base, dt_s, status.odometry);
}

Estimator::Estimator(const RobotModel& model, const EstimateSettings& settings, double dt_s)
    : settings_(settings),
      orientation_(make<OrientationFilter>(orientation_config(settings), "base orientation")),
      dt_s_(dt_s) {
  if (!(dt_s > 0 && std::isfinite(dt_s))) reject("dt_s = " + std::to_string(dt_s) + " must be > 0");
  add_joints(model, settings, dt_s);
  add_feet(model, settings);
  if (settings.channels.size() > max_channels)
    reject(std::to_string(settings.channels.size()) + " sensors, at most " + std::to_string(max_channels));
  health_.channel_count = static_cast<std::uint32_t>(settings.channels.size());
  health_.imu.period_ticks = std::max(1U, settings.imu_divisor);
  channels_.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < settings.channels.size(); ++i)
    health_.channels[i].period_ticks =
        static_cast<std::uint32_t>(std::max(1.0, std::ceil(settings.channels[i].period_s / dt_s - 1e-9)));
}

void Estimator::add_joints(const RobotModel& model, const EstimateSettings& settings, double dt_s) {
  if (model.joints.size() > max_joints)
    reject("the robot has " + std::to_string(model.joints.size()) + " joints, at most " + std::to_string(max_joints));
  check_size(settings.joint_velocity_cutoff_Hz, "joint_velocity_cutoff_Hz", model);
  check_size(settings.spring_Nm_per_rad, "spring_Nm_per_rad", model);
  check_size(settings.sample_divisor, "sample_divisor", model);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const std::string owner = "joint '" + model.joints[i].name + "'";
    const double spring_Nm_per_rad = of_joint(settings.spring_Nm_per_rad, i, 0.0);
    const std::uint32_t divisor = of_joint(settings.sample_divisor, i, std::uint32_t{1});
    if (!(spring_Nm_per_rad >= 0 && std::isfinite(spring_Nm_per_rad)))
      reject(owner + ": spring_Nm_per_rad = " + std::to_string(spring_Nm_per_rad) + " must be >= 0");
    if (divisor == 0) reject(owner + ": sample_divisor = 0 must be >= 1");
    const VelocityFilter::Config velocity{.cutoff_Hz = settings.cutoff_Hz(i), .dt_s = divisor * dt_s};
    joints_.push_back({.velocity = make<VelocityFilter>(velocity, owner + ": velocity"),
                       .spring_Nm_per_rad = spring_Nm_per_rad,
                       .paired = false,
                       .last_sequence = 0,
                       .elapsed_s = 0,
                       .state = {}});
    health_.joints[i].period_ticks = divisor;
  }
  health_.joint_count = static_cast<std::uint32_t>(model.joints.size());
  for (const Transmission& transmission : model.transmissions) {
    if (!transmission.coupled()) continue;
    const std::vector<std::size_t>& pair = transmission.joints();
    const Transmission::Pair spring{of_joint(settings.spring_Nm_per_rad, pair[0], 0.0),
                                    of_joint(settings.spring_Nm_per_rad, pair[1], 0.0)};
    if (spring[0] == 0 && spring[1] == 0) continue;
    pairs_.push_back({transmission, spring});
    for (const std::size_t joint : pair) {
      joints_[joint].spring_Nm_per_rad = 0;
      joints_[joint].paired = true;
    }
  }
}

void Estimator::add_feet(const RobotModel& model, const EstimateSettings& settings) {
  if (settings.feet.size() > max_feet)
    reject(std::to_string(settings.feet.size()) + " feet, at most " + std::to_string(max_feet));
  for (const EstimateFoot& foot : settings.feet) {
    const auto link = model.find_link(foot.link);
    if (!link) reject("foot: the robot has no link '" + foot.link + "'");
    const ContactDetector::Config contact{
        .on_N = settings.contact_on_N, .off_N = settings.contact_off_N, .sensors_m = foot.sensors_m};
    feet_.push_back({.detector = make<ContactDetector>(contact, "foot '" + foot.link + "'"),
                     .leg = LegChain(model, *link),
                     .bore = false,
                     .last_sequence = 0,
                     .force_N = {}});
  }
  health_.foot_count = static_cast<std::uint32_t>(feet_.size());
}

void declare_signals(SignalTable& table, const RobotModel& model, const EstimateSettings& settings,
                     const Snapshot& snapshot) {
  using enum StatusField::Part;
  for (std::size_t i = 0; i < model.joints.size(); ++i)
    declare_part(table, joint, "joint." + model.joints[i].name, snapshot, i);
  declare_part(table, base, "base", snapshot);
  declare_part(table, rate, "base", snapshot);
  for (std::size_t i = 0; i < settings.feet.size(); ++i)
    declare_part(table, foot, "foot." + settings.feet[i].link, snapshot, i);
  declare_part(table, support, "support", snapshot);
  for (std::size_t i = 0; i < settings.channels.size(); ++i) {
    const SensorChannel& channel = settings.channels[i];
    table.add({"sensor." + channel.name, channel.unit, channel.doc}, &snapshot.status.channels[i]);
  }
}

}  // namespace kadans
