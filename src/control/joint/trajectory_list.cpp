#include "trajectory_list.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double stop_s = 0.1;
constexpr double still_rad_s = 1e-6;
constexpr int points_per_tick_max = 4;

}  // namespace

void TrajectoryLaw::declare(AxisTables& tables) {
  tables.pid(pid_);
  tables.tunable("append", "", 0, 1, 1, &append_, "1: a set-point is added to the list; 0: it replaces the list.");
  tables.position_setpoint(0);
  tables.signal("waiting", "", "Points in the list.", &state_.waiting);
  tables.signal("underrun", "", "Whether a point is missing that was announced.", &state_.underrun);
  tables.signal("underruns", "", "How often one was.", &state_.underruns);
  tables.signal("dropped", "", "Set-points for which the list had no room.", &state_.dropped);
}

const ViaPoint& TrajectoryLaw::peek(std::size_t i) const noexcept {
  const std::size_t commanded = commanded_.size();
  return i < commanded ? commanded_.peek(i) : handed_.peek(i - commanded);
}

void TrajectoryLaw::drop_first() noexcept {
  if (commanded_.size() > 0) {
    commanded_.drop(1);
  } else {
    handed_.drop(1);
  }
}

void TrajectoryLaw::clear() noexcept {
  commanded_.drop(commanded_.size());
  handed_.drop(handed_.size());
  segment_.moving = false;
}

bool TrajectoryLaw::append(const ViaPoint& point) noexcept {
  const bool inside = point.position_rad >= axis_.lower_rad && point.position_rad <= axis_.upper_rad;
  const bool lasts = point.duration_s >= ViaPoint::duration_min_s && std::isfinite(point.duration_s);
  return inside && lasts && !std::isinf(point.velocity_rad_s) && handed_.try_push(point);
}

void TrajectoryLaw::set_point(std::uint32_t, double value, double duration_s) noexcept {
  if (append_ < 0.5 || duration_s == 0) clear();
  if (duration_s == 0) {
    reference_rad_ = value;
    reference_rad_s_ = 0;
  } else if (!commanded_.try_push(
                 {.position_rad = value, .duration_s = std::max(duration_s, ViaPoint::duration_min_s)})) {
    ++state_.dropped;
  }
}

void TrajectoryLaw::cancel(std::uint32_t) noexcept {
  clear();
  stop();
}

// Evenly slower, to rest.
void TrajectoryLaw::stop() noexcept {
  if (std::abs(reference_rad_s_) < still_rad_s) {
    reference_rad_s_ = 0;
    segment_.moving = false;
    return;
  }
  const double way_rad = 0.5 * stop_s * reference_rad_s_;
  const double end_rad = std::clamp(reference_rad_ + way_rad, axis_.lower_rad, axis_.upper_rad);
  segment_ = {.from_rad = reference_rad_,
              .from_rad_s = reference_rad_s_,
              .to_rad = end_rad,
              .duration_s = stop_s,
              .moving = true};
}

void TrajectoryLaw::fetch() noexcept {
  if (waiting() == 0) return;
  const ViaPoint point = peek(0);
  drop_first();
  const bool given = std::isfinite(point.velocity_rad_s);
  segment_ = {.from_rad = reference_rad_,
              .from_rad_s = reference_rad_s_,
              .to_rad = point.position_rad,
              .to_rad_s = given ? point.velocity_rad_s : 0,
              .duration_s = point.duration_s,
              .moving = true,
              .open = !given,
              .more = point.more};
  state_.underrun = false;
}

// The slope of the parabola through the points around the end, as far as the motion stays monotone.
void TrajectoryLaw::choose_end_velocity() noexcept {
  const double left_s = segment_.duration_s - segment_.time_s;
  if (!segment_.open || waiting() == 0 || left_s < ViaPoint::duration_min_s) return;
  const ViaPoint& next = peek(0);
  segment_.from_rad = reference_rad_;
  segment_.from_rad_s = reference_rad_s_;
  segment_.duration_s = left_s;
  segment_.time_s = 0;
  segment_.open = false;
  const double slope = (segment_.to_rad - segment_.from_rad) / left_s;
  const double slope_after = (next.position_rad - segment_.to_rad) / next.duration_s;
  if (slope * slope_after <= 0) return;  // turns, or rests
  const double parabola = (next.duration_s * slope + left_s * slope_after) / (left_s + next.duration_s);
  const double most = 3 * std::min(std::abs(slope), std::abs(slope_after));
  segment_.to_rad_s = std::clamp(parabola, -most, most);
}

void TrajectoryLaw::evaluate() noexcept {
  const Segment& s = segment_;
  const double T = s.duration_s, t = std::min(1.0, s.time_s / T), way = s.to_rad - s.from_rad;
  const double c1 = s.from_rad_s * T, c2 = 3 * way - (2 * s.from_rad_s + s.to_rad_s) * T;
  const double c3 = (s.from_rad_s + s.to_rad_s) * T - 2 * way;
  reference_rad_ = s.from_rad + t * (c1 + t * (c2 + t * c3));
  reference_rad_s_ = (c1 + t * (2 * c2 + t * 3 * c3)) / T;
}

void TrajectoryLaw::advance(double dt_s) noexcept {
  for (int i = 0; i < points_per_tick_max; ++i) {
    if (!segment_.moving) fetch();
    if (!segment_.moving) return;
    choose_end_velocity();
    segment_.time_s += dt_s;
    if (segment_.time_s < segment_.duration_s) return evaluate();
    dt_s = segment_.time_s - segment_.duration_s;
    const bool expected = segment_.more;
    reference_rad_ = segment_.to_rad;
    reference_rad_s_ = segment_.to_rad_s;
    segment_.moving = false;
    if (waiting() > 0) continue;
    state_.underrun = expected;
    if (expected) ++state_.underruns;
    stop();
    if (!segment_.moving) return;
  }
}

void TrajectoryLaw::start(const Takeover& takeover) noexcept {
  const JointState& joint = takeover.state;
  clear();
  state_ = {};
  reference_rad_ = joint.position_rad;
  reference_rad_s_ = joint.velocity_rad_s;
  stop();
  pid_.start(joint.position_rad, joint.velocity_rad_s, effort_before_Nm(takeover), reference_rad_s_);
}

JointActuation TrajectoryLaw::step(const JointState& joint, double dt_s) noexcept {
  advance(dt_s);
  state_.waiting = static_cast<std::uint32_t>(waiting());
  const double reference_rad = std::clamp(reference_rad_, std::min(axis_.lower_rad, joint.position_rad),
                                          std::max(axis_.upper_rad, joint.position_rad));
  const double effort_Nm = pid_.step(reference_rad, reference_rad_s_, joint.position_rad, joint.velocity_rad_s, dt_s);
  return {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
}

double TrajectoryLaw::remaining_s() const noexcept {
  double remaining_s = segment_.moving ? segment_.duration_s - segment_.time_s : 0;
  for (std::size_t i = 0, n = waiting(); i < n; ++i) remaining_s += peek(i).duration_s;
  return remaining_s;
}

std::unique_ptr<ControlObject> make_trajectory_list(const ObjectSetup& setup) {
  return std::make_unique<TrajectoryList>(setup);
}

}  // namespace kadans
