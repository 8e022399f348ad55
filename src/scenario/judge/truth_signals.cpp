#include "truth_signals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

double norm(const Vec3& v) noexcept { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

double tilt_rad(const Pose& pose) noexcept {
  const Vec3 up = rotate(pose.orientation, {0, 0, 1});
  return std::atan2(std::hypot(up[0], up[1]), up[2]);
}

}  // namespace

TruthSignals::TruthSignals(const TruthSource& plant, Catalog& catalog, const std::vector<Foot>& feet, double settle_s,
                           const WorldSettings& world, bool several)
    : plant_(plant), model_(*catalog.model), settle_s_(settle_s), kinematics_(*catalog.model) {
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const std::string& joint = model_.joints[i].name;
    writers_[i] = catalog.signals.find("composition." + joint + ".writers").value();
    for (std::uint32_t object = 0; object < catalog.objects.size(); ++object) {
      const auto signal =
          catalog.signals.find("control." + catalog.objects[object].name + "." + joint + ".reference_rad");
      if (signal) references_[i].push_back({object, *signal});
    }
  }
  for (const Foot& foot : feet) {
    FootState state;
    state.link = model_.find_link(foot.link).value();
    state.sole_m = foot.sole_m;
    foot_links_.set(state.link);
    feet_.push_back(std::move(state));
  }
  declare(catalog.signals, feet);
  declare_world(catalog.signals, world, several);
}

void TruthSignals::declare(SignalTable& table, const std::vector<Foot>& feet) {
  table.add({"plant.base.height_m", "m", "Height of the base frame over the ground."}, &state_.height_m);
  table.add({"plant.base.x_m", "m", "Position of the base frame."}, &state_.x_m);
  table.add({"plant.base.y_m", "m", "Position of the base frame."}, &state_.y_m);
  table.add({"plant.base.tilt_rad", "rad", "Angle between the base's z axis and the vertical."}, &state_.tilt_rad);
  table.add({"plant.base.yaw_rad", "rad", "Heading of the base."}, &state_.yaw_rad);
  table.add({"plant.base.speed_m_s", "m/s", "Speed of the base frame."}, &state_.speed_m_s);
  table.add({"plant.base.jump_m", "m", "Displacement of the base in one step, beyond what its speed explains."},
            &state_.jump_m);
  table.add({"plant.limits.position_rad", "rad",
             "Distance of the joint that is nearest to a position limit from that limit; negative beyond it."},
            &state_.position_rad);
  table.add({"plant.limits.motor_torque_share", "",
             "Largest torque of a motor as a share of its limit; what it cannot give at its speed counts as used up."},
            &state_.motor_torque_share);
  table.add({"plant.limits.torque_share", "", "Largest torque of a transmission on its joint as a share of its limit."},
            &state_.torque_share);
  table.add({"plant.limits.speed_share", "", "Largest joint velocity as a share of its limit."}, &state_.speed_share);
  table.add({"plant.limits.overspeed_s", "s", "Time for which a joint has now been faster than its limit."},
            &state_.overspeed_s);
  table.add({"plant.work_J", "J", "Mechanical work of all motors so far, braking counted as driving."}, &state_.work_J);
  table.add({"plant.solver.residual_m_s", "m/s",
             "Velocity by which the step's contacts and joints were not settled; beyond 0.01 its forces are not to be "
             "trusted."},
            &state_.residual_m_s);
  table.add({"reference.base.height_m", "m", "Height of the base with every joint at its set-point."},
            &state_.reference_height_m);
  table.add({"reference.base.error_m", "m", "Height of the base minus that of the set-points."},
            &state_.reference_error_m);
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const std::string foot = "plant.foot." + feet[i].link + ".";
    table.add({foot + "force_N", "N", "Vertical force of the ground on the foot."}, &feet_[i].force_N);
    table.add({foot + "slip_m", "m", "Distance that the foot has slid along the ground since it settled."},
              &feet_[i].slip_m);
  }
}

void TruthSignals::declare_world(SignalTable& table, const WorldSettings& world, bool several) {
  table.add({"plant.contact.other_links", "", "Links other than feet that press on the ground or an object."},
            &state_.other_links);
  if (several) {
    table.add({"plant.contact.robot_links", "", "Links that press on another robot."}, &state_.robot_links);
    table.add({"plant.contact.robots_force_N", "N", "Force from other robots."}, &state_.robots_force_N);
  }
  table.add({"plant.self_penetration_m", "m", "Largest overlap of two links of the robot."},
            &state_.self_penetration_m);
  objects_.resize(world.objects.size());
  for (std::size_t i = 0; i < objects_.size(); ++i) declare_object(table, world.objects[i], objects_[i]);
  if (!world.ground_motion.moves()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = "world.ground." + std::string(1, "xyz"[i]) + "_m";
    unhashed_.push_back(table.add({name, "m", "How far the ground has been driven."}, &state_.ground_m[i]));
  }
}

void TruthSignals::declare_object(SignalTable& table, const WorldObject& object, ObjectState& state) {
  const std::string name = "world." + object.name + ".";
  table.add({name + "force_N", "N", "Force of the robot on the object."}, &state.force_N);
  table.add({name + "links", "", "Links of the robot that press on the object."}, &state.links);
  if (!object.free() && !object.motion.moves()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    std::string velocity = name;
    velocity += "v" + axis + "_m_s";
    table.add({name + axis + "_m", "m", "Position of the object."}, &state.position_m[i]);
    table.add({velocity, "m/s", "Velocity of the object."}, &state.velocity_m_s[i]);
  }
  table.add({name + "tilt_rad", "rad", "Angle between the object's z axis and the vertical."}, &state.tilt_rad);
  if (!std::holds_alternative<WorldBox>(object.shape) || !object.free()) return;
  const char* const angles[] = {"roll_rad", "pitch_rad", "yaw_rad"};
  for (std::size_t i = 0; i < 3; ++i)
    unhashed_.push_back(table.add({name + angles[i], "rad", "How the object is turned."}, &state.angles_rad[i]));
}

void TruthSignals::watch(Catalog& catalog, const GazeTruth::Eyes& eyes) {
  gazes_.push_back(std::make_unique<GazeTruth>(plant_, catalog, eyes));
  gazes_.back()->declare(catalog.signals);
}

void TruthSignals::update_limits(double dt_s) noexcept {
  const PlantTruth& truth = plant_.truth();
  state_.position_rad = std::numeric_limits<double>::infinity();
  state_.motor_torque_share = state_.torque_share = state_.speed_share = state_.overspeed_s = 0;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const Joint& joint = model_.joints[i];
    const double inside = std::min(truth.position_rad[i] - joint.lower_rad, joint.upper_rad - truth.position_rad[i]);
    state_.position_rad = std::min(state_.position_rad, inside);
    if (!joint.passive()) {
      const double left_Nm = truth.motor_torque_max_Nm[i] - std::abs(truth.motor_torque_Nm[i]);
      // A torque at its limit in all substeps has a mean that is rounded.
      const double left_share = std::abs(left_Nm) < 1e-12 * joint.effort_max_Nm ? 0 : left_Nm / joint.effort_max_Nm;
      state_.motor_torque_share = std::max(state_.motor_torque_share, 1 - left_share);
      state_.torque_share = std::max(state_.torque_share, std::abs(truth.drive_torque_Nm[i]) / joint.effort_max_Nm);
    }
    state_.work_J += dt_s * std::abs(truth.motor_torque_Nm[i] * truth.velocity_rad_s[i]);
    if (joint.velocity_max_rad_s > 0) {
      const double share = std::abs(truth.velocity_rad_s[i]) / joint.velocity_max_rad_s;
      overspeed_s_[i] = share > 1 ? overspeed_s_[i] + dt_s : 0;
      state_.speed_share = std::max(state_.speed_share, share);
      state_.overspeed_s = std::max(state_.overspeed_s, overspeed_s_[i]);
    }
  }
}

void TruthSignals::update_jump(double dt_s) noexcept {
  const Vec3& at_m = plant_.truth().base.position_m;
  const double way_m = std::hypot(at_m[0] - last_m_[0], at_m[1] - last_m_[1], at_m[2] - last_m_[2]);
  const double fastest_m_s = std::max(last_m_s_, state_.speed_m_s);
  state_.jump_m = dt_s > 0 ? std::max(0.0, way_m - fastest_m_s * dt_s) : 0;
  last_m_ = at_m;
  last_m_s_ = state_.speed_m_s;
}

void TruthSignals::update_feet(double time_s) noexcept {
  const PlantTruth& truth = plant_.truth();
  for (std::size_t i = 0; i < feet_.size() && i < truth.foot_count; ++i) {
    FootState& foot = feet_[i];
    const Vec3& at_m = truth.feet[i].position_m;
    foot.force_N = truth.foot_force_N[i][2];
    if (!foot.settled && time_s >= settle_s_) {
      foot.settled = true;
      foot.settled_at_m = at_m;
    }
    if (foot.settled) foot.slip_m = std::hypot(at_m[0] - foot.settled_at_m[0], at_m[1] - foot.settled_at_m[1]);
  }
}

void TruthSignals::update_world() noexcept {
  const PlantTruth& truth = plant_.truth();
  state_.other_links = static_cast<double>((truth.touching_links & ~foot_links_).count());
  state_.robot_links = static_cast<double>(truth.robot_links.count());
  state_.robots_force_N = norm(truth.robots_force_N);
  state_.self_penetration_m = truth.self_penetration_m;
  state_.ground_m = truth.ground_m;
  const std::size_t count = std::min<std::size_t>(objects_.size(), truth.object_count);
  for (std::size_t i = 0; i < count; ++i) {
    const ObjectTruth& object = truth.objects[i];
    ObjectState& state = objects_[i];
    state.force_N = norm(object.force_N);
    state.links = static_cast<double>(object.links.count());
    state.position_m = object.pose.position_m;
    state.velocity_m_s = object.velocity_m_s;
    state.angles_rad = roll_pitch_yaw(object.pose.orientation);
    state.tilt_rad = tilt_rad(object.pose);
  }
}

// The set-point of the object that drives the joint; joints without one (passive ankles) count as they are.
double TruthSignals::reference_rad(std::size_t joint, std::span<const double> row) const noexcept {
  const auto writers = static_cast<std::uint32_t>(row[writers_[joint]]);
  for (const Reference& reference : references_[joint]) {
    if ((writers >> reference.object & 1U) != 0) return row[reference.signal];
  }
  return plant_.truth().position_rad[joint];
}

// The lowest point of the soles is the ground.
double TruthSignals::reference_height_m(std::span<const double> row) noexcept {
  const PlantTruth& truth = plant_.truth();
  const std::size_t joints = model_.joints.size();
  for (std::size_t i = 0; i < joints; ++i) position_rad_[i] = reference_rad(i, row);
  kinematics_.update({position_rad_.data(), joints}, {{0, 0, 0}, truth.base.orientation});
  double lowest_m = 0;
  for (const FootState& foot : feet_) {
    for (const Vec3& point : foot.sole_m) {
      lowest_m = std::min(lowest_m, transform(kinematics_.link(foot.link), point)[2]);
    }
  }
  return -lowest_m;
}

void TruthSignals::update(double time_s, std::span<const double> row) noexcept {
  const PlantTruth& truth = plant_.truth();
  state_.x_m = truth.base.position_m[0];
  state_.y_m = truth.base.position_m[1];
  state_.height_m = truth.base.position_m[2];
  state_.tilt_rad = tilt_rad(truth.base);
  state_.yaw_rad = roll_pitch_yaw(truth.base.orientation)[2];
  state_.residual_m_s = truth.residual_m_s;
  state_.speed_m_s = norm(truth.base_velocity_m_s);
  const double dt_s = last_s_ ? time_s - *last_s_ : 0;
  last_s_ = time_s;
  update_limits(dt_s);
  update_jump(dt_s);
  update_feet(time_s);
  update_world();
  for (const auto& gaze : gazes_) gaze->update(row);
  state_.reference_height_m = reference_height_m(row);
  state_.reference_error_m = state_.height_m - state_.reference_height_m;
}

GazeTruth::GazeTruth(const TruthSource& plant, const Catalog& catalog, const Eyes& eyes)
    : plant_(plant),
      object_(eyes.object),
      joints_(catalog.model->joints.size()),
      kinematics_(*catalog.model),
      links_{catalog.model->find_link(eyes.left).value(), catalog.model->find_link(eyes.right).value()} {
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    target_[i] = catalog.signals.find("control." + object_ + ".target_" + names[i] + "_m").value();
  }
}

void GazeTruth::declare(SignalTable& table) {
  const std::string prefix = "plant." + object_ + ".";
  table.add({prefix + "left_error_rad", "rad", "True angle between the left eye and the target."}, &error_rad_[0]);
  table.add({prefix + "right_error_rad", "rad", "True angle between the right eye and the target."}, &error_rad_[1]);
  table.add({prefix + "error_rad", "rad", "The larger of the two."}, &worst_rad_);
}

// In the base frame, where the target is given.
void GazeTruth::update(std::span<const double> row) noexcept {
  kinematics_.update({plant_.truth().position_rad.data(), joints_});
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const Pose& pose = kinematics_.link(links_[eye]);
    Vec3 way{};
    for (std::size_t i = 0; i < 3; ++i) way[i] = row[target_[i]] - pose.position_m[i];
    const Vec3 seen = rotate_inverse(pose.orientation, way);
    error_rad_[eye] = std::atan2(std::hypot(seen[1], seen[2]), seen[0]);
  }
  worst_rad_ = std::max(error_rad_[0], error_rad_[1]);
}

}  // namespace kadans
