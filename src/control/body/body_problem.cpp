#include "body_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double least_acceleration = 1e-5, least_force = 1e-6, least_moment = 1e-4;  // the regularisation
constexpr double calm_weight = 0.005, calm_per_s = 4;  // joints that no task needs come to rest
constexpr double passive_weight = 0.05;
constexpr double hold_per_s = 10;          // how fast a foot that stands goes back to its place
constexpr double catch_per_s = 8;          // how fast the capture point may approach an edge, per distance
constexpr double limit_per_s = 8;          // how fast a joint may approach its limit, per distance
constexpr double limit_margin_rad = 0.03;  // of positions before a limit; the safety layer's soft stop begins there
constexpr double react_s = 0.03;           // in which a joint that is too fast slows down
constexpr double braking_rad_s2 = 300;     // the most that limits of speed and position ask for
constexpr double loose_rad_s = 5;          // the fastest that a joint without a motor under load turns
constexpr double twist_m = 0.04;           // moment about the vertical per load and friction
constexpr double least_load_share = 0.4;   // the most that a foot must bear because of a bent joint without a motor
constexpr double load_share = 1.5;         // the most that a foot bears, as a share of the weight
constexpr double least_height_m = 0.05;
constexpr int tick_iterations_max = 250;
constexpr Index wrench_rows = 13;

Index rows_max(const BodyLayout& layout) {
  const Index joints = static_cast<Index>(layout.joints.size()), feet = static_cast<Index>(layout.feet.size());
  return 6 + static_cast<Index>(layout.locked.size()) + 2 * joints + feet * (5 + 6 + wrench_rows) +
         6 * static_cast<Index>(layout.tasks.size());
}

}  // namespace

WantedTurn wanted_turn(const SetpointState* s) noexcept {
  const Vector3d yaw_axis(0, 0, 1), pitch_axis(-std::sin(s[2].value), std::cos(s[2].value), 0);
  const Vector3d roll_axis = eigen(rotate(from_roll_pitch_yaw(0, s[1].value, s[2].value), {1, 0, 0}));
  return {from_roll_pitch_yaw(s[0].value, s[1].value, s[2].value),
          roll_axis * s[0].velocity + pitch_axis * s[1].velocity + yaw_axis * s[2].velocity,
          roll_axis * s[0].acceleration + pitch_axis * s[1].acceleration + yaw_axis * s[2].acceleration};
}

BodyProblem::BodyProblem(const BodyLayout& layout)
    : layout_(&layout),
      program_(static_cast<Index>(layout.model->joints.size() + (layout.floating ? 6 + 6 * layout.feet.size() : 0)),
               rows_max(layout)) {
  const auto n = static_cast<Index>(layout.model->joints.size() + (layout.floating ? 6 : 0));
  for (auto& wrench : kept_) wrench.setZero();
  for (auto& jacobian : foot_jacobian_) jacobian.setZero(6, n);
  for (Rows& rows : tasks_) rows.jacobian.setZero(6, n);
  jacobian_.setZero(6, n);
  acceleration_.setZero(n);
  effort_Nm_.setZero(static_cast<Index>(layout.model->joints.size()));
  row_.setZero(n);
}

void BodyProblem::begin(const BodyModel& model, const BodyAim& aim, const BodyPosture& to,
                        const std::array<BodyStand, body_feet_max>& feet) noexcept {
  Index size = model.size();
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    wrench_[i] = feet[i].stands() ? size : 0;
    size += feet[i].stands() ? 6 : 0;
    model.dynamics().link_jacobian(layout_->tasks[layout_->feet[i]].link, {}, foot_jacobian_[i]);
  }
  program_.begin(size);
  program_.hessian().diagonal().head(model.size()).setConstant(least_acceleration);
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (wrench_[i] == 0) continue;
    program_.hessian().diagonal().segment<3>(wrench_[i]).setConstant(least_force);
    program_.hessian().diagonal().segment<3>(wrench_[i] + 3).setConstant(least_moment);
  }
  for (Index row = 0; row < model.base_size(); ++row) motion_row(model, row, 0, 0);
  for (const std::size_t joint : layout_->locked)
    program_.add_row(0, 0)[model.base_size() + static_cast<Index>(joint)] = 1;
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (wrench_[i] == 0) continue;
    hold(model, i, feet[i]);
    bear(model, i, feet[i], aim.settings);
  }
  balance(model, aim.settings, feet);
  limit(model, aim.settings, feet);
  spring(model, aim.settings);
  posture(model, aim, to);
}

// lower <= force of this degree of freedom <= upper, with M dv + h - J' w for the force.
void BodyProblem::motion_row(const BodyModel& model, Index row, double lower, double upper) noexcept {
  const double bias = model.dynamics().bias()[row];
  auto normal = program_.add_row(lower - bias, upper - bias);
  normal.head(model.size()) = model.dynamics().mass_matrix().row(row).transpose();
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (wrench_[i] != 0) normal.segment<6>(wrench_[i]) = -foot_jacobian_[i].col(row);
  }
}

// J dv = -bias - 2 g J v + g^2 (way back to where it stands).
void BodyProblem::hold(const BodyModel& model, std::size_t foot, const BodyStand& stand) noexcept {
  const std::size_t link = layout_->tasks[layout_->feet[foot]].link;
  Eigen::Vector<double, 6> wanted = -model.bias(link, {}), way;
  way << eigen(stand.pose.position_m) - eigen(model.link(link).position_m),
      turn_between(model.link(link).orientation, stand.pose.orientation);
  wanted.noalias() -= 2 * hold_per_s * (foot_jacobian_[foot] * model.velocity);
  wanted += hold_per_s * hold_per_s * way;
  for (Index k = 0; k < 6; ++k)
    program_.add_row(wanted[k], wanted[k]).head(model.size()) = foot_jacobian_[foot].row(k).transpose();
}

// The wrench is about the foot's frame, in the axes of the task frame; its limits are in those of the sole.
void BodyProblem::bear(const BodyModel& model, std::size_t foot, const BodyStand& stand,
                       const BodySettings& s) noexcept {
  const Eigen::Matrix3d axes = matrix_of(stand.pose.orientation);
  const Vector3d x = axes.col(0), y = axes.col(1), z = axes.col(2);
  const double grip = s.friction / std::numbers::sqrt2;
  const auto add = [&](double lower, double upper, const Vector3d& force, const Vector3d& moment) {
    auto normal = program_.add_row(lower, upper);
    normal.segment<3>(wrench_[foot]) = force;
    normal.segment<3>(wrench_[foot] + 3) = moment;
  };
  const Vector3d none = Vector3d::Zero();
  const double weight_N = body_gravity_m_s2 * model.dynamics().mass_kg();
  const std::size_t loose = layout_->soles[foot].loose;
  const double bent_rad = loose == no_body_joint || stand.share < 1 ? 0 : model.position_rad[loose];
  add(std::min(bent_load_N(*layout_, s, foot, bent_rad), least_load_share * weight_N),
      stand.share * load_share * weight_N, z, none);
  for (const double sign : {-1.0, 1.0}) {
    add(0, QuadraticProgram::unbounded, grip * z + sign * x, none);
    add(0, QuadraticProgram::unbounded, grip * z + sign * y, none);
    add(0, QuadraticProgram::unbounded, twist_m * s.friction * z, sign * z);
    add(0, QuadraticProgram::unbounded, (s.side_m - s.edge_m) * z - sign * s.sole_m * y, sign * x);
  }
  add(0, QuadraticProgram::unbounded, (s.toe_m - s.edge_m) * z + s.sole_m * x, y);
  add(0, QuadraticProgram::unbounded, (s.heel_m - s.edge_m) * z - s.sole_m * x, -y);
}

// The capture point c + v / w with w = sqrt(g / height) may approach an edge ever more slowly. Beyond it, it goes back
// no faster than pressing at the soles' edge brings it back: it moves by w times its way from the centre of pressure.
void BodyProblem::balance(const BodyModel& model, const BodySettings& s,
                          const std::array<BodyStand, body_feet_max>& feet) noexcept {
  std::array<const Pose*, body_feet_max> standing{};
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) standing[i] = feet[i].share >= 1 ? &feet[i].pose : nullptr;
  const BodySupport support = support_of(*layout_, s, standing);
  if (support.count == 0) return;
  const Vec3 com = model.dynamics().com_m();
  const double rate_per_s = std::sqrt(body_gravity_m_s2 / std::max(com[2], least_height_m));
  model.dynamics().com_jacobian(jacobian_.topRows<3>());
  const Vector3d velocity = jacobian_.topRows<3>() * model.velocity, bias = model.com_bias();
  for (const BodyEdge& edge : support) {
    const Vector3d out(edge.x, edge.y, 0);
    const double speed = out.dot(velocity), caught_m = out.dot(eigen(com)) + speed / rate_per_s;
    const double room_m = edge.distance_m - s.balance_m - caught_m;
    const double most = std::max(catch_per_s * room_m, rate_per_s * (caught_m - edge.distance_m + s.edge_m));
    auto normal = program_.add_row(-QuadraticProgram::unbounded, rate_per_s * (most - speed) - out.dot(bias));
    normal.head(model.size()).noalias() = jacobian_.topRows<3>().transpose() * out;
  }
}

// The acceleration that keeps this degree of freedom within these bounds, which it approaches ever more slowly.
void BodyProblem::keep_within(Index at, double position, double velocity, double lower, double upper,
                              double fastest) noexcept {
  const double above = std::min(fastest, limit_per_s * (upper - position));
  const double below = std::max(-fastest, limit_per_s * (lower - position));
  const double most = std::clamp((above - velocity) / react_s, -braking_rad_s2, braking_rad_s2);
  const double least = std::clamp((below - velocity) / react_s, -braking_rad_s2, braking_rad_s2);
  program_.add_row(std::min(least, most), std::max(least, most))[at] = 1;
}

void BodyProblem::limit(const BodyModel& model, const BodySettings& s,
                        const std::array<BodyStand, body_feet_max>& feet) noexcept {
  for (const JointAxis& axis : layout_->joints) {
    const Index at = model.base_size() + static_cast<Index>(axis.joint);
    keep_within(at, model.position_rad[axis.joint], model.velocity[at], axis.lower_rad + limit_margin_rad,
                axis.upper_rad - limit_margin_rad, s.velocity_share * axis.velocity_max_rad_s);
    motion_row(model, at, -s.effort_share * axis.effort_max_Nm, s.effort_share * axis.effort_max_Nm);
  }
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    const std::size_t loose = layout_->soles[i].loose;
    if (loose == no_body_joint || feet[i].share < 1) continue;
    const double load_N = least_load_share * body_gravity_m_s2 * model.dynamics().mass_kg();
    const double most_rad = bent_max_rad(*layout_, s, i, load_N);
    const Index at = model.base_size() + static_cast<Index>(loose);
    if (std::isfinite(most_rad))
      keep_within(at, model.position_rad[loose], model.velocity[at], -most_rad, most_rad, loose_rad_s);
  }
}

void BodyProblem::spring(const BodyModel& model, const BodySettings& s) noexcept {
  for (const std::size_t joint : layout_->passive) {
    const Index at = model.base_size() + static_cast<Index>(joint);
    const double force = -s.passive_Nm_per_rad * model.position_rad[joint] - s.passive_Nms_per_rad * model.velocity[at];
    const double wanted = force - model.dynamics().bias()[at];
    row_.head(model.size()) = model.dynamics().mass_matrix().row(at).transpose();
    program_.add_square(
        program_.variables(),
        [&](Index k) {
          if (k < model.size()) return row_[k];
          for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
            if (wrench_[i] != 0 && k >= wrench_[i] && k < wrench_[i] + 6) return -foot_jacobian_[i](k - wrench_[i], at);
          }
          return 0.0;
        },
        wanted, passive_weight);
  }
}

void BodyProblem::posture(const BodyModel& model, const BodyAim& aim, const BodyPosture& posture) noexcept {
  const double g = posture.gain_per_s, weight = posture.weight;
  for (std::size_t i = 0; i < layout_->joints.size(); ++i) {
    const SetpointState& to = aim.setpoints[layout_->joint_channel + i];
    const std::size_t joint = layout_->joints[i].joint;
    const Index at = model.base_size() + static_cast<Index>(joint);
    const double wanted =
        to.acceleration + 2 * g * (to.velocity - model.velocity[at]) + g * g * (to.value - model.position_rad[joint]);
    program_.hessian()(at, at) += weight + calm_weight;
    program_.gradient()[at] -= weight * wanted - calm_weight * calm_per_s * model.velocity[at];
  }
}

void BodyProblem::find_tasks(const BodyModel& model, const BodyAim& aim, const BodyRanks& ranks,
                             const std::array<BodyStand, body_feet_max>& feet) noexcept {
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
    const BodyTask& task = layout_->tasks[i];
    Rows& rows = tasks_[i];
    rows.count = 0;
    rows.weight = ranks[i].weight;
    rows.level = ranks[i].weight > 0 ? ranks[i].level : 0;
    for (std::size_t foot = 0; foot < layout_->feet.size(); ++foot) {
      if (layout_->feet[foot] == i && feet[foot].stands()) rows.level = 0;
    }
    if (rows.level == 0) continue;
    if (task.kind == BodyTask::Kind::gaze) {
      lead_look(model, aim, i);
      continue;
    }
    if (task.has_point()) lead_point(model, aim, i);
    if (task.has_turn()) lead_turn(model, aim, i);
  }
}

void BodyProblem::lead_point(const BodyModel& model, const BodyAim& aim, std::size_t index) noexcept {
  const BodyTask& task = layout_->tasks[index];
  const BodySettings::Task& s = aim.settings.tasks[index];
  Rows& rows = tasks_[index];
  Vector3d at, bias;
  if (task.kind == BodyTask::Kind::com) {
    model.dynamics().com_jacobian(jacobian_.topRows<3>());
    at = eigen(model.dynamics().com_m());
    bias = model.com_bias();
  } else {
    model.dynamics().link_jacobian(task.link, s.point_m, jacobian_);
    at = eigen(transform(model.link(task.link), s.point_m));
    if (task.kind == BodyTask::Kind::foot) at.z() -= aim.settings.sole_m;
    bias = model.bias(task.link, s.point_m).head<3>();
  }
  rows.jacobian.topRows<3>() = jacobian_.topRows<3>();
  const double g = s.gain_per_s;
  for (Index k = 0; k < 3; ++k) {
    const SetpointState& to = aim.setpoints[task.channel + static_cast<std::size_t>(k)];
    const double velocity = jacobian_.row(k).dot(model.velocity);
    rows.wanted[k] = to.acceleration + 2 * g * (to.velocity - velocity) + g * g * (to.value - at[k]) - bias[k];
  }
  rows.count = 3;
}

void BodyProblem::lead_turn(const BodyModel& model, const BodyAim& aim, std::size_t index) noexcept {
  const BodyTask& task = layout_->tasks[index];
  const double g = aim.settings.tasks[index].gain_per_s;
  Rows& rows = tasks_[index];
  model.dynamics().link_jacobian(task.link, {}, jacobian_);
  const WantedTurn to = wanted_turn(&aim.setpoints[task.channel + (task.has_point() ? 3 : 0)]);
  const Vector3d velocity = jacobian_.bottomRows<3>() * model.velocity;
  rows.jacobian.middleRows<3>(rows.count) = jacobian_.bottomRows<3>();
  rows.wanted.segment<3>(rows.count) = to.acceleration_rad_s2 + 2 * g * (to.velocity_rad_s - velocity) +
                                       g * g * turn_between(model.link(task.link).orientation, to.orientation) -
                                       model.bias(task.link, {}).tail<3>();
  rows.count += 3;
}

// The link's x axis towards the point; the turn about this axis is free.
void BodyProblem::lead_look(const BodyModel& model, const BodyAim& aim, std::size_t index) noexcept {
  const BodyTask& task = layout_->tasks[index];
  const double g = aim.settings.tasks[index].gain_per_s;
  Rows& rows = tasks_[index];
  model.dynamics().link_jacobian(task.link, {}, jacobian_);
  const Pose& link = model.link(task.link);
  const Vector3d axis = eigen(rotate(link.orientation, {1, 0, 0}));
  Vector3d way;
  for (std::size_t k = 0; k < 3; ++k)
    way[static_cast<Index>(k)] = aim.setpoints[task.channel + k].value - link.position_m[k];
  const double distance = std::max(way.norm(), 1e-3), cosine = axis.dot(way) / distance;
  Vector3d turn = axis.cross(way) / distance;
  const double sine = turn.norm();
  turn *= sine > 1e-6 ? std::atan2(sine, cosine) / sine : 1;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  rows.jacobian.topRows<3>().noalias() = across * jacobian_.bottomRows<3>();
  const Vector3d velocity = rows.jacobian.topRows<3>() * model.velocity;
  rows.wanted.head<3>() = g * g * turn - 2 * g * velocity - across * model.bias(task.link, {}).tail<3>();
  rows.count = 3;
}

void BodyProblem::add_level(int level) noexcept {
  for (const Rows& rows : tasks_) {
    if (rows.level != level) continue;
    for (Index row = 0; row < rows.count; ++row) {
      program_.add_square(
          rows.jacobian.cols(), [&](Index k) { return rows.jacobian(row, k); }, rows.wanted[row], rows.weight);
    }
  }
}

// The solution into torques: M dv + h - J' w.
void BodyProblem::keep(const BodyModel& model) noexcept {
  const auto x = program_.solution();
  acceleration_ = x.head(model.size());
  for (std::size_t joint = 0; joint < layout_->model->joints.size(); ++joint) {
    const Index at = model.base_size() + static_cast<Index>(joint);
    double effort = model.dynamics().mass_matrix().row(at).dot(acceleration_) + model.dynamics().bias()[at];
    for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
      if (wrench_[i] != 0) effort -= foot_jacobian_[i].col(at).dot(x.segment<6>(wrench_[i]));
    }
    effort_Nm_[static_cast<Index>(joint)] = effort;
  }
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    kept_[i].setZero();
    if (wrench_[i] != 0) kept_[i] = x.segment<6>(wrench_[i]);
  }
}

void BodyProblem::pass_state(StateBytes& bytes) noexcept {
  for (double& effort : effort_Nm_) bytes.high_level(effort);
  for (auto& wrench : kept_) {
    for (double& part : wrench) bytes.high_level(part);
  }
}

bool BodyProblem::solve(const BodyModel& model, const BodyAim& aim, const BodyRanks& ranks, const BodyPosture& posture,
                        const std::array<BodyStand, body_feet_max>& feet) noexcept {
  begin(model, aim, posture, feet);
  find_tasks(model, aim, ranks, feet);
  add_level(1);
  status_ = program_.solve(tick_iterations_max);
  iterations_ = program_.iterations();
  const bool second = std::ranges::any_of(tasks_, [](const Rows& rows) { return rows.level == 2; });
  if (status_ != QuadraticProgram::Status::solved) return false;
  keep(model);
  if (!second) return true;
  for (const Rows& rows : tasks_) {
    for (Index row = 0; rows.level == 1 && row < rows.count; ++row) {
      const double reached = rows.jacobian.row(row).dot(acceleration_);
      program_.add_row(reached, reached).head(model.size()) = rows.jacobian.row(row).transpose();
    }
  }
  add_level(2);
  status_ = program_.solve(tick_iterations_max);
  iterations_ += program_.iterations();
  if (status_ == QuadraticProgram::Status::solved) keep(model);
  return true;  // the first level's solution stands
}

}  // namespace kadans
