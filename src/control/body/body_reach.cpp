#include "body_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "body_leader.h"

namespace kadans {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr int settle_steps_max = 8, way_steps = 16, end_steps_max = 2, last_steps_max = 8, reach_iterations_max = 200;
constexpr double asked_weight = 1, change_weight = 3e-4;
constexpr double way_weight = 0.03, last_weight = 1e-4;  // of the other tasks: on the way, and to say how far it stays
constexpr double step_max_rad = 0.4;                     // of a joint, in one step
constexpr double bent_share = 0.33;                      // of the weight, that the foot which bears less still bears
constexpr double back_m = 0.03;  // how far the centre of mass comes back over the soles in one step
constexpr double still = 5e-4;   // a step after which no other is made
// What counts as reached. Where both feet stand, a turn is known no better than their springs bend and encoders read.
constexpr double reached_m = 0.005, reached_rad = 0.02;
constexpr double at_once = 2.4;      // the time in which a task without a motion gets there, times its gain
constexpr double told_share = 1.02;  // of the least time, so that what is told is enough when it is asked for again

}  // namespace

BodyReach::BodyReach(const BodyLayout& layout)
    : layout_(&layout),
      known_(BodySettings{}),
      model_(*layout.model, layout.floating),
      kinematics_(*layout.model),
      program_(model_.size(), model_.size() + static_cast<Index>(6 * layout.feet.size() + 4 * body_feet_max)),
      gone_(layout),
      clash_(*layout.model) {
  jacobian_.setZero(6, model_.size());
  way_.setZero(model_.size());
}

Foresight::Miss BodyReach::miss(const Asked& asked, const Snapshot& snapshot) noexcept {
  settings_ = known_.newest();
  if (!place(snapshot)) return {};
  const Setpoints from = setpoints_;
  if (!ask(asked.goals)) return {};
  if (const Miss loose = bearing(); loose.why != Why::none) return loose;
  std::array<const Pose*, body_feet_max> standing{};
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) standing[i] = stands(i) ? &held_[i] : nullptr;
  support_ = support_of(*layout_, settings_, standing);
  const double time_s = time_of(asked.time_s);
  const Setpoints to = setpoints_;
  go(from, to, time_s);
  Miss missed = worst();
  for (int step = 0; step < last_steps_max && missed.why != Why::none && improve(last_weight); ++step) missed = worst();
  const BodyWay::Time least = gone_.time();
  if (missed.why != Why::none) return missed;
  if (!(tilt_rad_ <= settings_.tilt_max_rad)) return {.why = Why::tilt, .by = tilt_rad_};
  if (clashing_.found())
    return {.why = Why::clash, .by = clear_share_, .link = clashing_.link, .other = clashing_.other};
  if (least.jumps != no_body_joint) return {.why = Why::jump, .by = least.smooth_share, .joint = least.jumps};
  if (least.least_s <= time_s) return missed;
  return {.why = least.joint == no_body_joint ? Why::topple : Why::speed,
          .by = told_share * least.least_s,
          .after_s = least.fails_after_s,
          .joint = least.joint};
}

// What acts at once is as quick as the gain of the quickest of its tasks.
double BodyReach::time_of(double asked_s) const noexcept {
  if (asked_s > 0) return asked_s;
  double gain_per_s = 0;
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
    if (asked_[i]) gain_per_s = std::max(gain_per_s, settings_.tasks[i].gain_per_s);
  }
  return gain_per_s > 0 ? at_once / gain_per_s : 1;
}

// Along the motion, as the engine leads its set-points: a minimum-jerk curve.
void BodyReach::go(const Setpoints& from, const Setpoints& to, double time_s) noexcept {
  std::ranges::copy_n(from.begin(), layout_->contact_channel, setpoints_.begin());
  for (int step = 0; step < settle_steps_max && improve(way_weight); ++step) {  // what the joints miss is no motion
  }
  model_.update();
  gone_.begin(settings_, support_, way_steps, time_s);
  clash_.begin(model_);
  clashing_ = {};
  tilt_rad_ = 0;
  for (int number = 0; number <= way_steps + end_steps_max; ++number) {
    const double u = std::min(1.0, static_cast<double>(number + 1) / way_steps);
    const double share = u * u * u * (10 + u * (6 * u - 15));
    for (std::uint32_t i = 0; i < layout_->contact_channel; ++i)
      setpoints_[i].value = from[i].value + share * (to[i].value - from[i].value);
    const bool moves = improve(way_weight);
    if (layout_->floating)
      tilt_rad_ = std::max(tilt_rad_, std::acos(std::clamp(rotate(model_.base.orientation, {0, 0, 1})[2], -1.0, 1.0)));
    // The links are still where they were before the step.
    if (number < way_steps) gone_.add(model_, way_);
    if (!clashing_.found()) {
      clashing_ = clash_.find(model_);
      clear_share_ = std::min(1.0, static_cast<double>(number) / way_steps);
    }
    if (number >= way_steps && !moves) return;
  }
}

// False: nothing is asked of the tasks or the contacts.
bool BodyReach::ask(std::span<const Goal> goals) noexcept {
  asked_.fill(false);
  bool any = false;
  for (const Goal& goal : goals) {
    setpoints_[goal.channel] = {.value = goal.value};
    any = any || goal.channel < layout_->lead_channel;
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
  return any;
}

// On one foot the body is an inverted pendulum over it. A joint without a motor on the way to it must have a spring
// that is stiffer than gravity is strong.
Foresight::Miss BodyReach::bearing() const noexcept {
  std::size_t count = 0, last = 0;
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (!stands(i)) continue;
    ++count;
    last = i;
  }
  if (count != 1 || layout_->soles[last].loose == no_body_joint) return {};
  const BodyLayout::Sole& sole = layout_->soles[last];
  const double height_m = model_.com_m()[2] - model_.link(sole.loose + 1).position_m[2];
  const double missing = body_gravity_m_s2 * model_.mass_kg() * height_m - settings_.passive_Nm_per_rad;
  if (!(missing > 0) || !(sole.tilts_forward || sole.tilts_sideways)) return {};
  return {.why = Why::bear, .by = missing, .joint = sole.loose};
}

// False: not all is measured.
bool BodyReach::place(const Snapshot& snapshot) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < model_.position_rad.size(); ++i)
    sum += model_.position_rad[i] = snapshot.joints.joints[i].position_rad;
  for (const double part : snapshot.status.base.orientation) sum += layout_->floating ? part : 0;
  if (!std::isfinite(sum)) return false;
  model_.base = body_start(*layout_, settings_, kinematics_, model_.position_rad, snapshot.status.base.orientation);
  present_setpoints(*layout_, settings_, kinematics_, setpoints_);
  stand_as_told(snapshot);
  for (std::size_t i = 0; i < layout_->feet.size(); ++i)
    held_[i] = kinematics_.link(layout_->tasks[layout_->feet[i]].link);
  model_.update();
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

void BodyReach::hold_feet() noexcept {
  for (std::size_t i = 0; i < layout_->feet.size(); ++i) {
    if (!stands(i)) continue;
    const std::size_t link = layout_->tasks[layout_->feet[i]].link;
    model_.link_jacobian(link, {}, jacobian_);
    Eigen::Vector<double, 6> way;
    way << eigen(held_[i].position_m) - eigen(model_.link(link).position_m),
        turn_between(model_.link(link).orientation, held_[i].orientation);
    for (Index k = 0; k < 6; ++k) program_.add_row(way[k], way[k]) = jacobian_.row(k).transpose();
  }
}

void BodyReach::balance() noexcept {
  if (support_.count == 0) return;
  const Vec3 com = model_.com_m();
  model_.com_jacobian(jacobian_);
  for (const BodyEdge& edge : support_) {
    const double room = edge.distance_m - settings_.balance_m - edge.x * com[0] - edge.y * com[1];
    program_.add_row(-QuadraticProgram::unbounded, std::max(room, -back_m)) =
        edge.x * jacobian_.row(0).transpose() + edge.y * jacobian_.row(1).transpose();
  }
}

void BodyReach::limit() noexcept {
  for (std::size_t i = 0; i < model_.position_rad.size(); ++i) {
    const Joint& joint = layout_->model->joints[i];
    double lower_rad = joint.lower_rad, upper_rad = joint.upper_rad;
    for (std::size_t foot = 0; foot < layout_->feet.size(); ++foot) {
      if (layout_->soles[foot].loose != i || !stands(foot)) continue;
      const double load_N = bent_share * body_gravity_m_s2 * model_.mass_kg();
      const double most_rad = bent_max_rad(*layout_, settings_, foot, load_N);
      lower_rad = std::max(lower_rad, -most_rad);
      upper_rad = std::min(upper_rad, most_rad);
    }
    const bool locked = std::ranges::find(layout_->locked, i) != layout_->locked.end();
    const double below = std::clamp(lower_rad - model_.position_rad[i], -step_max_rad, step_max_rad);
    const double above = std::clamp(upper_rad - model_.position_rad[i], -step_max_rad, step_max_rad);
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
    model_.com_jacobian(jacobian_);
  else
    model_.link_jacobian(task.link, settings_.tasks[index].point_m, jacobian_);
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
  Vec3 at = task.kind == BodyTask::Kind::com ? model_.com_m() : transform(link, settings_.tasks[index].point_m);
  if (task.kind == BodyTask::Kind::foot) at[2] -= settings_.sole_m;
  way.head<3>() = wanted - eigen(at);
  if (!task.has_turn()) return 3;
  way.tail<3>() = turn_between(link.orientation, wanted_turn(to + 3).orientation);
  return 6;
}

void BodyReach::add_task(std::size_t index, double other_weight) noexcept {
  Eigen::Vector<double, 6> way;
  const Index rows = missing(index, way);
  const double weight = asked_[index] ? asked_weight : other_weight;
  for (Index row = 0; row < rows; ++row)
    program_.add_square(
        model_.size(), [&](Index k) { return jacobian_(row, k); }, way[row], weight);
}

// One step; false: it was the last one.
bool BodyReach::improve(double other_weight) noexcept {
  model_.update();
  program_.begin(model_.size());
  program_.hessian().diagonal().setConstant(change_weight);
  hold_feet();
  balance();
  limit();
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
    const bool foot_stands = std::ranges::any_of(std::array<std::size_t, 2>{0, 1}, [&](std::size_t foot) {
      return foot < layout_->feet.size() && layout_->feet[foot] == i && stands(foot);
    });
    if (asked_[i] || (!layout_->tasks[i].idles() && !foot_stands)) add_task(i, other_weight);
  }
  const bool solved = program_.solve(reach_iterations_max) == QuadraticProgram::Status::solved;
  way_.setZero();
  if (!solved) return false;
  way_ = program_.solution();
  model_.move(way_);
  return way_.cwiseAbs().maxCoeff() > still;
}

double BodyReach::beyond_edges_m() const noexcept {
  double beyond_m = 0;
  const Vec3& com = model_.com_m();
  for (const BodyEdge& edge : support_)
    beyond_m = std::max(beyond_m, edge.x * com[0] + edge.y * com[1] - edge.distance_m + settings_.balance_m);
  return beyond_m;
}

Foresight::Miss BodyReach::worst() noexcept {
  model_.update();
  Miss worst{.by = beyond_edges_m()};
  if (!(worst.by > reached_m)) worst.by = 0;
  Eigen::Vector<double, 6> way;
  for (std::size_t i = 0; i < layout_->tasks.size(); ++i) {
    if (!asked_[i]) continue;
    const BodyTask& task = layout_->tasks[i];
    const Index rows = missing(i, way);
    const bool turns_only = task.kind == BodyTask::Kind::trunk || task.kind == BodyTask::Kind::gaze;
    const double first = way.head<3>().norm(), turn = rows == 6 ? way.tail<3>().norm() : 0;
    if (first > (turns_only ? reached_rad : reached_m) && first > worst.by)
      worst = {.by = first, .channel = task.channel};
    if (turn > reached_rad && turn > worst.by) worst = {.by = turn, .channel = task.channel + 3};
  }
  worst.why = worst.by > 0 ? Why::reach : Why::none;
  return worst;
}

}  // namespace kadans
