#include "gravity_compensation.h"

#include <algorithm>
#include <cmath>

#include "kadans/control/model_state.h"

namespace kadans {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
constexpr double gain_rate_per_s = 1 / FadingEffort::fade_s;

}  // namespace

GravityCompensation::GravityCompensation(const ObjectSetup& setup) : model_(std::make_unique<ModelState>(setup.model)) {
  for (JointAxis& axis : joint_axes(setup)) parts_.push_back({.axis = std::move(axis)});
  const auto joints = static_cast<Eigen::Index>(setup.model.joints.size());
  slope_.setZero(joints, joints);
}

GravityCompensation::~GravityCompensation() = default;

void GravityCompensation::declare(Declaration& declaration) {
  declaration.parameter({"gain", "", 0, 1, 1, "Share of gravity that is compensated."}, &config_.gain);
  declaration.signal({"gain", "", "Share of gravity that is compensated."}, &gain_);
  declaration.signal({"model_age_s", "s", "Age of the measurement from which the gravity torques were computed."},
                     &model_age_s_);
  for (Part& part : parts_) {
    AxisTables tables(declaration, part.axis, 0);
    const double most = part.axis.effort_max_Nm;
    tables.tunable("effort_max_Nm", "Nm", 0, most, most, &part.effort_max_Nm, "Bound of the torque.");
    tables.signal("effort_Nm", "Nm", "Torque asked for.", &part.state.effort_Nm);
    tables.signal("saturated", "", "Whether the torque is limited.", &part.state.saturated);
  }
}

void GravityCompensation::update(const Snapshot& snapshot) {
  if (!model_->update(snapshot)) return;
  const Dynamics& dynamics = model_->dynamics();
  dynamics.gravity_gradient(slope_);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::size_t joint = parts_[i].axis.joint;
    const auto row = static_cast<Eigen::Index>(joint);
    draft_.position_rad[i] = model_->position_rad(joint);
    draft_.gravity_Nm[i] = dynamics.gravity()[row];
    for (std::size_t j = 0; j <= i; ++j) {
      draft_.slope_Nm_per_rad(i, j) = slope_(row, static_cast<Eigen::Index>(parts_[j].axis.joint));
    }
  }
  draft_.time_ns = snapshot.time_ns;
  data_.publish(draft_);
}

void GravityCompensation::start(const ControlInput& input) noexcept {
  started_ns_ = input.time_ns;
  gain_ = config_.gain;
  for (Part& part : parts_) {
    const std::size_t joint = part.axis.joint;
    part.takeover.start(effort_before_Nm({input.joints.joints[joint], input.last.joints[joint], input.dt_s}));
  }
}

void GravityCompensation::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const auto newest = data_.read();
  const GravityData& data = *newest;
  const bool known = data.time_ns >= started_ns_;
  model_age_s_ = 1e-9 * static_cast<double>(input.time_ns - (known ? data.time_ns : started_ns_));
  const double most = gain_rate_per_s * input.dt_s;
  gain_ += std::clamp(config_.gain - gain_, -most, most);
  std::array<double, max_joints> way_rad{};
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double position_rad = input.joints.joints[parts_[i].axis.joint].position_rad;
    if (std::isfinite(position_rad)) way_rad[i] = position_rad - data.position_rad[i];
  }
  const std::array<double, max_joints> change_Nm = data.slope_Nm_per_rad.times(way_rad, parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    State& s = part.state;
    const bool measured = std::isfinite(input.joints.joints[part.axis.joint].position_rad);
    const double law_Nm = measured ? gain_ * (data.gravity_Nm[i] + change_Nm[i]) : not_measured;
    double integral_Nm = 0;  // there is none
    const double offset_Nm = part.takeover.step(law_Nm, known, input.dt_s, integral_Nm, 0);
    s.effort_Nm = std::clamp(law_Nm + offset_Nm, -part.effort_max_Nm, part.effort_max_Nm);
    s.saturated = s.effort_Nm != law_Nm + offset_Nm;
    if (std::isfinite(s.effort_Nm)) part.takeover.leave(s.effort_Nm);
    actuation.joints[part.axis.joint] = {.effort_Nm = s.effort_Nm, .mode = ActuationMode::effort};
  }
}

void GravityCompensation::pass_state(StateBytes& bytes) noexcept {
  for (Part& part : parts_) bytes(part.state, part.takeover);
  bytes(gain_, started_ns_, model_age_s_);
  bytes.newest(data_);
}

std::unique_ptr<ControlObject> make_gravity_compensation(const ObjectSetup& setup) {
  return std::make_unique<GravityCompensation>(setup);
}

}  // namespace kadans
