#include "step_plan.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double late_s = 0.2;          // a foot that finds no ground until then counts as put down
constexpr double sink_m_s = 0.3;        // how it looks for it
constexpr double far_m = 0.1;           // a step so long goes further than xi by the whole of what is told
constexpr double earliest_share = 0.5;  // of a swing, to land
constexpr double place_s = 0.05;        // in which the feet's places are followed, both bearing
constexpr double rate_smooth_s = 0.01;  // low pass of xi's rate

double side(std::size_t foot) noexcept { return foot == 0 ? 1 : -1; }  // of left: +y

}  // namespace

GroundPoint StepPlan::foot(std::size_t foot) const noexcept {
  if (foot == state_.stance) return {};
  return {state_.from_m[0], state_.from_m[1]};
}

void StepPlan::see_feet(const Sight& sight) noexcept {
  const Vec3& a = sight.over[state_.stance].foot_m;
  const Vec3& b = sight.over[1 - state_.stance].foot_m;
  state_.from_m = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

// Over the stance foot; with both down, by what each of them bears. Landings shake what is measured: from the first
// step on xi is led by its law, xi' = w0 (xi - p), and by the measurement only as far as it is trusted.
void StepPlan::look(const Config& c, const Sight& sight, double dt_s) noexcept {
  State& s = state_;
  const std::size_t other = 1 - s.stance;
  const double all_N = std::max(sight.force_N[0], 0.0) + std::max(sight.force_N[1], 0.0);
  const double share = s.phase == Phase::swings ? 0 : (all_N > 1 ? std::max(sight.force_N[other], 0.0) / all_N : 0.5);
  const DcmMeasure::OverFoot& a = sight.over[s.stance];
  const DcmMeasure::OverFoot& b = sight.over[other];
  const GroundPoint seen{a.dcm_x_m + share * (b.dcm_x_m + s.from_m[0] - a.dcm_x_m),
                         a.dcm_y_m + share * (b.dcm_y_m + s.from_m[1] - a.dcm_y_m)};
  if (s.phase != Phase::stands) {
    const double p_x_m = (1 - share) * sight.cop_x_m[s.stance] + share * (s.from_m[0] + sight.cop_x_m[other]);
    const double w = sight.rate_per_s, trust = c.trust_per_s;
    s.dcm.x_m += dt_s * (w * (s.dcm.x_m - p_x_m) + trust * (seen.x_m - s.dcm.x_m));
    s.dcm.y_m += dt_s * (w * (s.dcm.y_m - share * s.from_m[1]) + trust * (seen.y_m - s.dcm.y_m));
    return;
  }
  if (looked_) s.dcm_rate_m_s += dt_s / rate_smooth_s * ((seen.x_m - s.dcm.x_m) / dt_s - s.dcm_rate_m_s);
  looked_ = true;
  s.dcm = seen;
}

void StepPlan::enter(Phase phase) noexcept {
  state_.phase = phase;
  state_.time_s = 0;
}

void StepPlan::begin_swing(const Sight& sight, std::size_t swing) noexcept {
  State& s = state_;
  if (s.stance == swing) {  // seen from the other foot now
    s.dcm = {s.dcm.x_m - s.from_m[0], s.dcm.y_m - s.from_m[1]};
    s.stance = 1 - swing;
  }
  ++s.steps;
  s.touchdown = {};
  see_feet(sight);
  s.foothold = {s.from_m[0], s.from_m[1]};
  enter(Phase::swings);
}

void StepPlan::choose_foothold(const Config& c, double rate_per_s) noexcept {
  State& s = state_;
  const double sign = side(1 - s.stance);
  const GroundPoint then = run_away(s.dcm, s.in_sole, rate_per_s, std::max(c.swing_s - s.time_s, 0.0));
  const double ahead_m = then.x_m - c.sole.middle_m();
  s.foothold = {std::clamp(ahead_m + c.extra_x_m * std::clamp(ahead_m / far_m, -1.0, 1.0), -c.reach_m, c.reach_m),
                sign * std::clamp(sign * then.y_m + c.extra_y_m, c.apart_min_m, c.apart_max_m)};
}

void StepPlan::stand(const Config& c, const Sight& sight) noexcept {
  State& s = state_;
  const std::size_t front = (s.from_m[0] > 0) == (s.stance == 0) ? 1 : 0;
  const double least_m = std::min(s.from_m[0], 0.0), most_m = std::max(s.from_m[0], 0.0);
  const double then_m = s.dcm.x_m + c.ahead_s * s.dcm_rate_m_s;
  if (then_m > most_m + c.front_m)
    begin_swing(sight, 1 - front);
  else if (then_m < least_m - c.back_m)
    begin_swing(sight, front);
}

void StepPlan::swing(const Config& c, const Sight& sight, double dt_s) noexcept {
  State& s = state_;
  s.in_sole = {std::clamp((1 + c.pressure_gain) * s.dcm.x_m, -c.sole.heel_m, c.sole.toe_m), 0};
  s.right_share = s.stance == 1 ? 1 : 0;
  choose_foothold(c, sight.rate_per_s);
  s.touchdown.look(sight.force_N[1 - s.stance], c.touch_N, dt_s);
  const bool down = s.time_s > earliest_share * c.swing_s && s.touchdown.landed(c.touch_s);
  if (down || s.time_s > c.swing_s + late_s) land(sight);
}

void StepPlan::land(const Sight& sight) noexcept {
  see_feet(sight);
  state_.from_m[2] = 0;  // the ground is level; a foot lands on an edge
  enter(Phase::bears);
}

void StepPlan::bear(const Config& c, const Sight& sight, double dt_s) noexcept {
  State& s = state_;
  const double least_N = std::min(sight.force_N[0], sight.force_N[1]);
  for (std::size_t i = 0; i < 2 && least_N > c.touch_N; ++i) {  // a foot that landed on an edge stands elsewhere
    const double apart_m = sight.over[1 - s.stance].foot_m[i] - sight.over[s.stance].foot_m[i];
    s.from_m[i] += dt_s / place_s * (apart_m - s.from_m[i]);
  }
  const GroundPoint left = foot(0), right = foot(1);
  s.goal = {(left.x_m + right.x_m) / 2 + c.goal_x_m, (left.y_m + right.y_m) / 2};
  const LoadSplit split = split_load(
      c.sole, left, right,
      {s.dcm.x_m + c.pressure_gain * (s.dcm.x_m - s.goal.x_m), s.dcm.y_m + c.pressure_gain * (s.dcm.y_m - s.goal.y_m)});
  s.in_sole = split.in_sole;
  s.right_share = split.right_share;
  if (s.time_s < c.settle_s || beyond_soles(c.sole, left, right, s.dcm) < c.again_m) return;
  begin_swing(sight, split_load({}, left, right, s.dcm).right_share < 0.5 ? 1 : 0);
}

void StepPlan::advance(const Config& c, const Sight& sight, double dt_s) noexcept {
  state_.time_s += dt_s;
  if (state_.phase == Phase::stands) see_feet(sight);
  look(c, sight, dt_s);
  if (state_.phase == Phase::stands) {
    stand(c, sight);
  } else if (state_.phase == Phase::swings) {
    swing(c, sight, dt_s);
  } else {
    bear(c, sight, dt_s);
  }
}

Vec3 StepPlan::other_foot(const Config& c) const noexcept {
  const State& s = state_;
  if (s.phase != Phase::swings) return s.from_m;
  const double share = s.time_s / c.swing_s, way = swing_way(share);
  const double sink_m = sink_m_s * std::max(s.time_s - c.swing_s, 0.0);
  return {s.from_m[0] + way * (s.foothold.x_m - s.from_m[0]), s.from_m[1] + way * (s.foothold.y_m - s.from_m[1]),
          s.from_m[2] * (1 - way) + c.lift_m * swing_lift(share) - std::min(sink_m, 0.05)};
}

LoadSplit split_load(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                     const GroundPoint& wanted) noexcept {
  const double way_x_m = right.x_m - left.x_m, way_y_m = right.y_m - left.y_m;
  const double length2 = std::max(way_x_m * way_x_m + way_y_m * way_y_m, 1e-9);
  const double x_m = wanted.x_m - left.x_m - sole.middle_m(), y_m = wanted.y_m - left.y_m;
  LoadSplit bearing;
  bearing.right_share = std::clamp((x_m * way_x_m + y_m * way_y_m) / length2, 0.0, 1.0);
  const double share = bearing.right_share;
  bearing.in_sole.x_m = std::clamp(wanted.x_m - left.x_m - share * way_x_m, -sole.heel_m, sole.toe_m);
  bearing.in_sole.y_m = std::clamp(wanted.y_m - left.y_m - share * way_y_m, -sole.half_width_m, sole.half_width_m);
  bearing.at = {left.x_m + share * way_x_m + bearing.in_sole.x_m, left.y_m + share * way_y_m + bearing.in_sole.y_m};
  return bearing;
}

double beyond_soles(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                    const GroundPoint& point) noexcept {
  const GroundPoint at = split_load(sole, left, right, point).at;
  return std::hypot(point.x_m - at.x_m, point.y_m - at.y_m);
}

GroundPoint run_away(const GroundPoint& dcm, const GroundPoint& pressure, double rate_per_s, double time_s) noexcept {
  const double growth = std::exp(rate_per_s * time_s);
  return {pressure.x_m + (dcm.x_m - pressure.x_m) * growth, pressure.y_m + (dcm.y_m - pressure.y_m) * growth};
}

double swing_way(double share) noexcept {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10 + s * (-15 + 6 * s));
}

double swing_lift(double share) noexcept {
  constexpr double up = 0.4, down = 0.5;
  return share < down ? swing_way(share / up) : swing_way((1 - share) / (1 - down));
}

}  // namespace kadans
