#include "gaze_solver.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace kadans {
namespace {

constexpr double near_m = 0.05;              // a target nearer than this counts as so far away
constexpr double steep = 0.1;                // h / distance from which on a target above an eye turns its yaw less
constexpr double barrier_margin_rad = 0.03;  // before a position limit
constexpr double approach_per_s = 20;        // of a position limit, at the end
constexpr double braking = 0.7;              // share of acceleration_max that stops a joint before it
constexpr double eyes_singular = 0.5;  // volume of what the eyes can do, below which the damping rises; ahead it is 1.4

bool moves(const RobotModel& model, std::size_t joint, std::size_t link) {
  for (std::size_t at = link; at > 0; at = model.joints[at - 1].parent) {
    if (at - 1 == joint) return true;
  }
  return false;
}

// A direction in an eye's frame, and how its pitch and yaw change with it.
struct Bearing {
  Vec3 at_m;
  double flat_m, far_m;

  explicit Bearing(const Vec3& at) noexcept
      : at_m(at), flat_m(std::hypot(at[0], at[1])), far_m(std::max(near_m, std::hypot(flat_m, at[2]))) {
    flat_m = std::max(flat_m, steep * far_m);
  }
  double pitch_rad() const noexcept { return -std::atan2(at_m[2], std::hypot(at_m[0], at_m[1])); }
  double yaw_rad() const noexcept { return std::atan2(at_m[1], at_m[0]); }
  double angle_rad() const noexcept { return std::atan2(std::hypot(at_m[1], at_m[2]), at_m[0]); }
  double pitch_rate(const Vec3& v) const noexcept {
    const double outward = (at_m[0] * v[0] + at_m[1] * v[1]) / flat_m;
    return -(flat_m * v[2] - at_m[2] * outward) / (far_m * far_m);
  }
  double yaw_rate(const Vec3& v) const noexcept { return (at_m[0] * v[1] - at_m[1] * v[0]) / (flat_m * flat_m); }
};

}  // namespace

GazeSolver::GazeSolver(const RobotModel& model, const GazeLinks& links, const std::vector<std::size_t>& joints)
    : model_(&model), kinematics_(model), eyes_{links.left_eye, links.right_eye} {
  if (joints.size() > gaze_joints_max) throw std::invalid_argument("a gaze has at most 12 joints");
  for (const std::size_t index : joints) {
    const Joint& joint = model.joints.at(index);
    Part part{.joint = index, .limits = {joint.lower_rad, joint.upper_rad, joint.velocity_max_rad_s}};
    for (std::size_t eye = 0; eye < 2; ++eye) part.moves[eye] = moves(model, index, eyes_[eye]);
    if (!part.moves[0] && !part.moves[1]) throw std::invalid_argument("joint " + joint.name + " moves neither eye");
    if (joint.type == JointType::prismatic) throw std::invalid_argument("joint " + joint.name + " slides");
    part.of_eye = !moves(model, index, links.head);
    part.law.velocity_max_rad_s = joint.velocity_max_rad_s;
    joints_.push_back(part);
  }
  jacobian_.setZero(4, static_cast<Eigen::Index>(joints_.size()));
}

Vec3 GazeSolver::point_ahead(const std::vector<double>& position_rad, double distance_m) noexcept {
  kinematics_.update(position_rad);
  Vec3 point{};
  for (const std::size_t eye : eyes_) {
    const Vec3 seen = transform(kinematics_.link(eye), {distance_m, 0, 0});
    for (std::size_t i = 0; i < 3; ++i) point[i] += 0.5 * seen[i];
  }
  return point;
}

// Error, drift and Jacobian, with the kinematics as they are.
void GazeSolver::see(const Target& target) noexcept {
  jacobian_.setZero();
  for (std::size_t eye = 0; eye < 2; ++eye) {
    const Pose& pose = kinematics_.link(eyes_[eye]);
    const Bearing bearing(rotate_inverse(pose.orientation, difference(target.point_m, pose.position_m)));
    const auto row = static_cast<Eigen::Index>(2 * eye);
    const auto write = [&](auto&& column, const Vec3& v, double sign) {
      column[row] = sign * bearing.pitch_rate(v);
      column[row + 1] = sign * bearing.yaw_rate(v);
    };
    error_[row] = bearing.pitch_rad();
    error_[row + 1] = bearing.yaw_rad();
    angle_rad_[eye] = bearing.angle_rad();
    write(drift_, rotate_inverse(pose.orientation, target.velocity_m_s), 1);
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (!joints_[i].moves[eye]) continue;
      const Pose& at = kinematics_.link(joints_[i].joint + 1);
      const Vec3 axis = rotate(at.orientation, model_->joints[joints_[i].joint].axis);
      const Vec3 moved = cross(difference(target.point_m, at.position_m), axis);  // of the target, as the eye sees it
      write(jacobian_.col(static_cast<Eigen::Index>(i)), rotate_inverse(pose.orientation, moved), -1);
    }
  }
  go_round();
}

// To a target behind the head both eyes go on one side: that which is shorter for the eye that is nearer to it, else
// they would each pull the neck to the other's side, and it would stand still.
void GazeSolver::go_round() noexcept {
  constexpr double pi = std::numbers::pi;
  double& left = error_[1];
  double& right = error_[3];
  if (std::min(std::abs(left), std::abs(right)) < pi / 2 || left * right > 0) return;
  double& farther = std::abs(left) > std::abs(right) ? left : right;
  farther += farther < 0 ? 2 * pi : -2 * pi;
}

double GazeSolver::damping2() const noexcept {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, static_cast<int>(gaze_joints_max),
                static_cast<int>(gaze_joints_max)>
      gram;
  Eigen::Index count = 0;
  std::array<Eigen::Index, gaze_joints_max> eyes{};
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].of_eye) eyes[static_cast<std::size_t>(count++)] = static_cast<Eigen::Index>(i);
  }
  gram.resize(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      gram(i, j) =
          jacobian_.col(eyes[static_cast<std::size_t>(i)]).dot(jacobian_.col(eyes[static_cast<std::size_t>(j)]));
    }
  }
  const double least = settings_.damping * settings_.damping;
  const double most = std::max(least, settings_.damping_singular * settings_.damping_singular);
  const double volume = count > 0 ? std::sqrt(std::max(0.0, gram.determinant())) : 0;
  const double lost = std::clamp(1 - volume / eyes_singular, 0.0, 1.0);
  return least + (most - least) * lost * lost;
}

GazeSolver::Bounds GazeSolver::bounds(const Part& part, double position_rad) const noexcept {
  const double most = part.law.velocity_max_rad_s;
  const double below = approach_per_s * (part.limits.lower_rad + barrier_margin_rad - position_rad);
  const double above = approach_per_s * (part.limits.upper_rad - barrier_margin_rad - position_rad);
  return {std::clamp(below, -1e3 * most, most), std::clamp(above, -most, 1e3 * most)};
}

// As fast as it may be, and can still stop before its limit in this direction. Near it the bounds are lower, so that a
// joint that stands there does not hold the others.
double GazeSolver::most_rad_s(const Part& part, double position_rad, double velocity_rad_s) noexcept {
  const double room_rad =
      velocity_rad_s < 0 ? position_rad - part.limits.lower_rad : part.limits.upper_rad - position_rad;
  const double left_rad = std::max(1e-6, room_rad - barrier_margin_rad);
  return std::min(part.law.velocity_max_rad_s, std::sqrt(2 * braking * part.law.acceleration_max_rad_s2 * left_rad));
}

// The task's share: damped least squares over the joints that are free, the others held at their bounds.
void GazeSolver::lead(const std::vector<double>& position_rad, double damping2, Solution& solution) const noexcept {
  auto& velocity = solution.velocity_rad_s;
  const Task wanted = settings_.gain_per_s * error_ + drift_;
  std::array<bool, gaze_joints_max> held{};
  Task rest = wanted;
  for (std::size_t round = 0; round <= joints_.size(); ++round) {
    Eigen::Matrix4d matrix = damping2 * Eigen::Matrix4d::Identity();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const auto column = jacobian_.col(static_cast<Eigen::Index>(i));
      if (!held[i]) matrix += column * column.transpose() / joints_[i].law.weight;
    }
    const Task pull = matrix.ldlt().solve(rest);
    std::size_t worst = joints_.size();
    double beyond = 1e-9, bound = 0;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (held[i]) continue;
      velocity[i] = jacobian_.col(static_cast<Eigen::Index>(i)).dot(pull) / joints_[i].law.weight;
      const Bounds b = bounds(joints_[i], position_rad[joints_[i].joint]);
      const double allowed = std::clamp(velocity[i], b.lowest_rad_s, b.highest_rad_s);
      if (std::abs(velocity[i] - allowed) <= beyond) continue;
      beyond = std::abs(velocity[i] - allowed);
      worst = i;
      bound = allowed;
    }
    if (worst == joints_.size()) break;
    held[worst] = solution.at_limit = true;
    velocity[worst] = bound;
    rest -= jacobian_.col(static_cast<Eigen::Index>(worst)) * bound;
  }
  Task brought = Task::Zero();
  double share = 1;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    brought += jacobian_.col(static_cast<Eigen::Index>(i)) * velocity[i];
    const double most = most_rad_s(joints_[i], position_rad[joints_[i].joint], velocity[i]);
    if (std::abs(velocity[i]) * share > most) share = most / std::abs(velocity[i]);
  }
  const double wish = settings_.gain_per_s * error_.squaredNorm();
  solution.progress = wish > 0 ? error_.dot(brought - drift_) / wish : 1;
  solution.scaled = share < 1;
  for (std::size_t i = 0; i < joints_.size(); ++i) velocity[i] *= share;
}

// Adds the null space's share: as far as position limits allow joint by joint, and speed limits for all together.
void GazeSolver::centre(const std::vector<double>& position_rad, double damping2, Solution& solution) const noexcept {
  std::array<bool, gaze_joints_max> held{};
  std::array<double, gaze_joints_max> added{};
  auto& velocity = solution.velocity_rad_s;
  for (std::size_t round = 0; round <= joints_.size(); ++round) {
    Eigen::Matrix4d matrix = damping2 * Eigen::Matrix4d::Identity();
    Task seen = Task::Zero();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      added[i] = held[i] ? 0 : -settings_.null_per_s * joints_[i].law.centring * position_rad[joints_[i].joint];
      const auto column = jacobian_.col(static_cast<Eigen::Index>(i));
      if (!held[i]) matrix += column * column.transpose();
      seen += column * added[i];
    }
    const Task pull = matrix.ldlt().solve(seen);
    bool passes = true;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (held[i]) continue;
      added[i] -= jacobian_.col(static_cast<Eigen::Index>(i)).dot(pull);
      const Bounds b = bounds(joints_[i], position_rad[joints_[i].joint]);
      const double sum = velocity[i] + added[i];
      if (sum >= b.lowest_rad_s - 1e-9 && sum <= b.highest_rad_s + 1e-9) continue;
      held[i] = true;
      passes = false;
    }
    if (passes) break;
  }
  double share = 1;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double most = joints_[i].law.velocity_max_rad_s;
    const double room = std::max(0.0, added[i] > 0 ? most - velocity[i] : most + velocity[i]);
    if (std::abs(added[i]) * share > room) share = room / std::abs(added[i]);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) velocity[i] += share * added[i];
}

void GazeSolver::counter(double damping2, Solution& solution) const noexcept {
  Eigen::Matrix4d matrix = damping2 * Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto column = jacobian_.col(static_cast<Eigen::Index>(i));
    if (joints_[i].of_eye) matrix += column * column.transpose();
  }
  const Eigen::LDLT<Eigen::Matrix4d> solver(matrix);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (joints_[j].of_eye) continue;
    const Task pull = solver.solve(jacobian_.col(static_cast<Eigen::Index>(j)));
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      solution.counter[i][j] = joints_[i].of_eye ? -jacobian_.col(static_cast<Eigen::Index>(i)).dot(pull) : 0;
    }
  }
}

bool GazeSolver::solve(const std::vector<double>& position_rad, const Target& target, Solution& solution) noexcept {
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::ranges::all_of(position_rad, finite) || !std::ranges::all_of(target.point_m, finite) ||
      !std::ranges::all_of(target.velocity_m_s, finite))
    return false;
  kinematics_.update(position_rad);
  see(target);
  const double damping = damping2();
  solution = {};
  solution.left_rad = angle_rad_[0];
  solution.right_rad = angle_rad_[1];
  lead(position_rad, damping, solution);
  centre(position_rad, damping, solution);
  counter(damping, solution);
  return true;
}

}  // namespace kadans
