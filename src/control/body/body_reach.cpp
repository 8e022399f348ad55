#include "body_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "body_leader.h"

namespace kadans {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr int steps_max = 20, reach_iterations_max = 200;
constexpr double asked_weight = 1, other_weight = 1e-4, change_weight = 1e-5;
constexpr double step_max_rad = 0.4;  // of a joint, in one step
constexpr double back_m = 0.03;       // how far the centre of mass comes back over the soles in one step
constexpr double still = 5e-4;        // a step after which no other is made
constexpr double reached_m = 0.005, reached_rad = 0.01;  // what counts as reached

double cross2(const Vec3& o, const Vec3& a, const Vec3& b) noexcept {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

}  // namespace

BodyReach::BodyReach(const BodyLayout& layout)
    : layout_(&layout),
      model_(*layout.model, layout.floating ? Dynamics::Base::floating : Dynamics::Base::fixed, {}),
      kinematics_(*layout.model),
      program_(model_.size(), model_.size() + static_cast<Index>(6 * layout.feet.size() + 4 * body_feet_max)),
      way_(model_.velocity) {
  jacobian_.setZero(6, model_.size());
}

Foresight::Miss BodyReach::miss(std::span<const Goal> goals, const Snapshot& snapshot) noexcept {
  if (!place(snapshot)) return {};
  asked_.fill(false);
  for (const Goal& goal : goals) {
    setpoints_[goal.channel] = {.value = goal.value};
    for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
      const BodyTask& task = layout_->tasks[i];
      if (goal.channel >= task.channel && goal.channel < task.channel + task.channels()) asked_[i] = true;
    }
  }
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {  // what it balances with stays where it was told to be
    for (std::size_t task = 0; task < layout_->tasks.size(); ++task) {
      if (!stands(i) && layout_->tasks[task].kind == BodyTask::Kind::com) asked_[task] = true;
    }
  }
  find_edges();
  for (int step = 0; step < steps_max && improve(); ++step) {
  }
  return worst();
}

// False: not all is measured.
bool BodyReach::place(const Snapshot& snapshot) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < model_.position_rad.size(); ++i)
    sum += model_.position_rad[i] = snapshot.joints.joints[i].position_rad;
  for (const double part : snapshot.status.base.orientation) sum += part;
  if (!std::isfinite(sum)) return false;
  model_.base = body_start(*layout_, settings_, kinematics_, model_.position_rad, snapshot.status.base.orientation);
  present_setpoints(*layout_, settings_, kinematics_, setpoints_);
  stand_as_told(snapshot);
  for (std::size_t i = 0; i < layout_->feet.size(); ++i)
    held_[i] = kinematics_.link(layout_->tasks[layout_->feet[i]].link);
  return true;
}

// While the object is active, its set-points say where the feet stand in its frame.
void BodyReach::stand_as_told(const Snapshot& snapshot) noexcept {
  for (std::uint32_t channel = 0; channel < layout_->channels(); ++channel) {
    const SetpointId id = first_ + channel;
    const double value = id < max_setpoints_shown && id < snapshot.setpoint_count
                             ? snapshot.setpoints[id].value
                             : std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(value)) return;
    setpoints_[channel] = {.value = value};
  }
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (!stands(i)) continue;
    const BodyTask& task = layout_->tasks[layout_->feet[i]];
    const SetpointState* at = &setpoints_[task.channel];
    const Pose told{{at[0].value, at[1].value, at[2].value + settings_.sole_m},
                    from_roll_pitch_yaw(at[3].value, at[4].value, at[5].value)};
    kinematics_.update(model_.position_rad);
    const Pose foot = kinematics_.link(task.link);
    const Quat base = multiply(told.orientation, conjugate(foot.orientation));
    const Vec3 arm = rotate(base, foot.position_m);
    model_.base = {{told.position_m[0] - arm[0], told.position_m[1] - arm[1], told.position_m[2] - arm[2]}, base};
    kinematics_.update(model_.position_rad, model_.base);
    return;
  }
}

// The convex hull of the soles that stand, by Andrew's monotone chain (1979, Information Processing Letters 9(5)).
void BodyReach::find_edges() noexcept {
  std::array<Vec3, 4 * body_feet_max> corners{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (!stands(i)) continue;
    for (const double x : {settings_.toe_m, -settings_.heel_m}) {
      for (const double y : {settings_.side_m, -settings_.side_m})
        corners[count++] = transform(held_[i], {x, y, -settings_.sole_m});
    }
  }
  edge_count_ = 0;
  if (count == 0) return;
  const auto last = corners.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(corners.begin(), last, last);  // gcc believes that std::sort leaves so small an array
  std::array<Vec3, 8 * body_feet_max + 1> hull{};
  std::size_t size = 0;
  const auto add = [&](const Vec3& corner, std::size_t kept) {
    while (size >= kept + 2 && cross2(hull[size - 2], hull[size - 1], corner) <= 0) --size;
    hull[size++] = corner;
  };
  for (std::size_t i = 0; i < count; ++i) add(corners[i], 0);
  const std::size_t lower = size - 1;
  for (std::size_t i = count - 1; i-- > 0;) add(corners[i], lower);
  for (std::size_t i = 0; i + 1 < size; ++i) {
    const double x = hull[i + 1][0] - hull[i][0], y = hull[i + 1][1] - hull[i][1], length = std::hypot(x, y);
    const double nx = y / length, ny = -x / length;  // outward, for a hull that goes round to the left
    edges_[edge_count_++] = {nx, ny, nx * hull[i][0] + ny * hull[i][1] - settings_.edge_m};
  }
}

void BodyReach::hold_feet() noexcept {
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (!stands(i)) continue;
    const std::size_t link = layout_->tasks[layout_->feet[i]].link;
    model_.dynamics().link_jacobian(link, {}, jacobian_);
    Eigen::Vector<double, 6> way;
    way << eigen(held_[i].position_m) - eigen(model_.link(link).position_m),
        turn_between(model_.link(link).orientation, held_[i].orientation);
    for (Index k = 0; k < 6; ++k) program_.add_row(way[k], way[k]) = jacobian_.row(k).transpose();
  }
}

void BodyReach::balance() noexcept {
  if (edge_count_ == 0) return;
  const Vec3 com = model_.dynamics().com_m();
  model_.dynamics().com_jacobian(jacobian_.topRows<3>());
  for (std::size_t i = 0; i < edge_count_; ++i) {
    const Edge& edge = edges_[i];
    const double room = edge.distance_m - edge.x * com[0] - edge.y * com[1];
    program_.add_row(-QuadraticProgram::unbounded, std::max(room, -back_m)) =
        edge.x * jacobian_.row(0).transpose() + edge.y * jacobian_.row(1).transpose();
  }
}

void BodyReach::limit() noexcept {
  for (std::size_t i = 0; i < model_.position_rad.size(); ++i) {
    const Joint& joint = layout_->model->joints[i];
    const bool locked = std::ranges::find(layout_->locked, i) != layout_->locked.end();
    const double below = std::clamp(joint.lower_rad - model_.position_rad[i], -step_max_rad, step_max_rad);
    const double above = std::clamp(joint.upper_rad - model_.position_rad[i], -step_max_rad, step_max_rad);
    program_.add_row(locked ? 0 : std::min(below, above),
                     locked ? 0 : std::max(below, above))[model_.base_size() + static_cast<Index>(i)] = 1;
  }
}

// The way that is left, and the Jacobian of its rows in jacobian_.
Index BodyReach::missing(std::size_t index, Eigen::Vector<double, 6>& way) noexcept {
  const BodyTask& task = layout_->tasks[index];
  const SetpointState* to = &setpoints_[task.channel];
  const Pose& link = model_.link(task.link);
  if (task.kind == BodyTask::Kind::com)
    model_.dynamics().com_jacobian(jacobian_.topRows<3>());
  else
    model_.dynamics().link_jacobian(task.link, settings_.tasks[index].point_m, jacobian_);
  const Vector3d wanted(to[0].value, to[1].value, to[2].value);
  if (task.kind == BodyTask::Kind::gaze) {
    const Vector3d axis = eigen(rotate(link.orientation, {1, 0, 0})), line = wanted - eigen(link.position_m);
    const Vector3d turn = axis.cross(line);
    const double sine = turn.norm(), angle = std::atan2(sine, axis.dot(line));
    way.head<3>() = sine > 1e-9 ? Vector3d(turn * (angle / sine)) : Vector3d::Zero();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    jacobian_.topRows<3>() = across * jacobian_.bottomRows<3>();
    return 3;
  }
  if (task.kind == BodyTask::Kind::trunk) {
    way.head<3>() = turn_between(link.orientation, wanted_turn(to).orientation);
    jacobian_.topRows<3>() = jacobian_.bottomRows<3>();
    return 3;
  }
  Vec3 at =
      task.kind == BodyTask::Kind::com ? model_.dynamics().com_m() : transform(link, settings_.tasks[index].point_m);
  if (task.kind == BodyTask::Kind::foot) at[2] -= settings_.sole_m;
  way.head<3>() = wanted - eigen(at);
  if (!task.has_turn()) return 3;
  way.tail<3>() = turn_between(link.orientation, wanted_turn(to + 3).orientation);
  return 6;
}

void BodyReach::add_task(std::size_t index) noexcept {
  Eigen::Vector<double, 6> way;
  const Index rows = missing(index, way);
  const double weight = asked_[index] ? asked_weight : other_weight;
  for (Index row = 0; row < rows; ++row)
    program_.add_square(
        model_.size(), [&](Index k) { return jacobian_(row, k); }, way[row], weight);
}

// One step; false: it was the last one.
bool BodyReach::improve() noexcept {
  model_.update();
  program_.begin(model_.size());
  program_.hessian().diagonal().setConstant(change_weight);
  hold_feet();
  balance();
  limit();
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
    const BodyTask::Kind kind = layout_->tasks[i].kind;
    const bool foot_stands = std::ranges::any_of(std::array<std::size_t, 2>{0, 1}, [&](std::size_t foot) {
      return foot < layout_->feet.size() && layout_->feet[foot] == i && stands(foot);
    });
    const bool idle = kind == BodyTask::Kind::hand || kind == BodyTask::Kind::gaze;
    if (asked_[i] || (!idle && !foot_stands)) add_task(i);
  }
  if (program_.solve(reach_iterations_max) != QuadraticProgram::Status::solved) return false;
  way_ = program_.solution();
  model_.move(way_);
  return way_.cwiseAbs().maxCoeff() > still;
}

double BodyReach::beyond_edges_m() const noexcept {
  double beyond_m = 0;
  const Vec3 com = model_.dynamics().com_m();
  for (std::size_t i = 0; i < edge_count_; ++i)
    beyond_m = std::max(beyond_m, edges_[i].x * com[0] + edges_[i].y * com[1] - edges_[i].distance_m);
  return beyond_m;
}

Foresight::Miss BodyReach::worst() noexcept {
  model_.update();
  Miss worst{.by = beyond_edges_m(), .channel = 0};
  if (!(worst.by > reached_m)) worst.by = 0;
  Eigen::Vector<double, 6> way;
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
    if (!asked_[i]) continue;
    const BodyTask& task = layout_->tasks[i];
    const Index rows = missing(i, way);
    const bool turns_only = task.kind == BodyTask::Kind::trunk || task.kind == BodyTask::Kind::gaze;
    const double first = way.head<3>().norm(), turn = rows == 6 ? way.tail<3>().norm() : 0;
    if (first > (turns_only ? reached_rad : reached_m) && first > worst.by) worst = {first, task.channel};
    if (turn > reached_rad && turn > worst.by) worst = {turn, task.channel + 3};
  }
  return worst;
}

}  // namespace kadans
