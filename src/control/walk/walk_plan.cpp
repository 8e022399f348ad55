#include "walk_plan.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr std::size_t times_tried = 16;
constexpr double late_s = 0.25;    // a foot that finds no ground until then counts as put down
constexpr double astray_m = 0.03;  // by which xi is nearer to the foot that was to swing: then the other one does
constexpr double flat_s = 0.05;    // after a landing, from which on the foot lies flat
constexpr double smooth_s = 0.02;  // of the measured pressure

// A robot that sank rests while xi is over the feet, and steps on when it is up again and xi near the middle.
constexpr double safe_share = 0.5, held_share = 0.9;  // of a sole before and behind: to begin to rest, to go on with it
constexpr double stop_share = 0.7;                    // likewise, to end the steps
constexpr double up_share = 0.3;                      // of sunk_m: what counts as up
constexpr double still_m = 0.03;

double side_of(std::size_t foot) noexcept { return foot == 0 ? 1 : -1; }  // of left: +y

// Where a parabola through three equidistant values is lowest, in their distance from the middle one, which is the
// least.
double lowest(double before, double middle, double after) noexcept {
  const double bend = before - 2 * middle + after;
  return bend > 0 ? 0.5 * (before - after) / bend : 0;
}

double toward(double from, double to, double most) noexcept { return from + std::clamp(to - from, -most, most); }

}  // namespace

void WalkPlan::begin(const Config& c, const Sight& sight) noexcept {
  state_ = {};
  sway(c, sight);
}

// The foot that is farther from xi will swing.
void WalkPlan::sway(const Config& c, const Sight& sight) noexcept {
  State& s = state_;
  if (s.phase == Phase::stands) s.dcm = {sight.over[s.stance].dcm_x_m, sight.over[s.stance].dcm_y_m};
  s.phase = Phase::sways;
  s.time_s = 0;
  s.meant.turn_rad = 0;
  const Vec3 &a = sight.over[s.stance].foot_m, &b = sight.over[1 - s.stance].foot_m;
  const GroundPoint from_other{s.dcm.x_m - (b[0] - a[0]), s.dcm.y_m - (b[1] - a[1])};
  if (std::abs(from_other.y_m) < std::abs(s.dcm.y_m)) {
    s.stance = 1 - s.stance;
    s.dcm = from_other;
  }
  leave(sight);
  s.step_s = c.step_s;
  from_com_m_ = {sight.over[s.stance].com_m[0], sight.over[s.stance].com_m[1]};
}

// Whether the first step begins, or the other foot turns out to be the one that xi is near.
bool WalkPlan::swayed(const Config& c, const Sight& sight) noexcept {
  State& s = state_;
  const double time_s = s.time_s;
  if (std::abs(s.dcm.y_m - s.feet.from_m[1]) + astray_m < std::abs(s.dcm.y_m)) {
    sway(c, sight);
    s.time_s = time_s;
    return true;
  }
  const double reached_m = c.width_m / (std::exp(c.side_rate_share * sight.rate_per_s * c.step_s) + 1);
  if (std::abs(s.dcm.y_m) > reached_m && time_s < c.sway_s) return false;
  s.phase = Phase::steps;
  s.time_s = 0;
  leave(sight);
  return true;
}

// Both feet do not hold it any more: it steps at once.
bool WalkPlan::step_out(const Config& c, const Sight& sight) noexcept {
  sway(c, sight);
  state_.phase = Phase::steps;
  return true;
}

// The other foot is about to leave the ground.
void WalkPlan::leave(const Sight& sight) noexcept {
  const Vec3 &a = sight.over[state_.stance].foot_m, &b = sight.over[1 - state_.stance].foot_m;
  const double x_m = b[0] - a[0], y_m = b[1] - a[1];
  state_.feet.from_m = state_.feet.at_m = {x_m, y_m, b[2] - a[2] - sight.slope.x_m * x_m - sight.slope.y_m * y_m};
}

GroundPoint WalkPlan::goal(const Config& c, const Sight& sight) const noexcept {
  const State& s = state_;
  const Vec3 &a = sight.over[s.stance].foot_m, &b = sight.over[1 - s.stance].foot_m;
  const GroundPoint middle{(b[0] - a[0]) / 2 + c.shift_x_m, (b[1] - a[1]) / 2};
  return s.phase == Phase::sways ? GroundPoint{middle.x_m, 0} : middle;
}

void WalkPlan::follow_wanted(const Config& c, const Wanted& wanted, double dt_s) noexcept {
  State& s = state_;
  const double most = (wanted.go ? c.speed_max_m_s2 : c.brake_m_s2) * dt_s;
  s.meant.velocity.forward_m_s =
      toward(s.meant.velocity.forward_m_s, wanted.go ? wanted.velocity.forward_m_s : 0, most);
  s.meant.velocity.left_m_s = toward(s.meant.velocity.left_m_s, wanted.go ? wanted.velocity.left_m_s : 0, most);
  s.meant.velocity.turn_rad_s =
      toward(s.meant.velocity.turn_rad_s, wanted.go ? wanted.velocity.turn_rad_s : 0, 4 * most);
}

// xi follows its law from the measured pressure, and the measurement as far as that is trusted.
void WalkPlan::look(const Config& c, const Sight& sight, double dt_s) noexcept {
  State& s = state_;
  const std::size_t other = 1 - s.stance;
  const double a_N = std::max(sight.force_N[s.stance], 0.0), b_N = std::max(sight.force_N[other], 0.0);
  const double share = a_N + b_N > 1 ? b_N / (a_N + b_N) : 0;
  const Vec3 &a = sight.over[s.stance].foot_m, &b = sight.over[other].foot_m;
  const double p_x_m = (1 - share) * sight.cop_x_m[s.stance] + share * (b[0] - a[0] + sight.cop_x_m[other]);
  const double p_y_m = (1 - share) * sight.cop_y_m[s.stance] + share * (b[1] - a[1] + sight.cop_y_m[other]);
  const DcmMeasure::OverFoot &seen = sight.over[s.stance], &beside = sight.over[other];
  const double of_other = c.by_load * share;
  const GroundPoint missed{seen.dcm_x_m + of_other * (beside.dcm_x_m + b[0] - a[0] - seen.dcm_x_m) - s.dcm.x_m,
                           seen.dcm_y_m + of_other * (beside.dcm_y_m + b[1] - a[1] - seen.dcm_y_m) - s.dcm.y_m};
  const double trust_per_s = s.phase == Phase::steps ? c.trust_per_s : c.both_trust_per_s;
  s.dcm.x_m += dt_s * (sight.rate_per_s * (s.dcm.x_m - p_x_m) + trust_per_s * missed.x_m);
  s.dcm.y_m += dt_s * (sight.rate_per_s * (s.dcm.y_m - p_y_m) + trust_per_s * missed.y_m);
  if (s.phase == Phase::steps && s.time_s > flat_s)
    s.in_sole_y_m += std::min(dt_s / smooth_s, 1.0) * (sight.cop_y_m[s.stance] - s.in_sole_y_m);
}

// Where the other foot goes, and xi relative to it at the landing, when nothing disturbs. A step that prepares a kick
// ends with xi where the step of the kick begins: further ahead, as that step is long, and for its longer time.
void WalkPlan::mean(const Config& c, const Sight& sight, const Kick& kick) noexcept {
  State& s = state_;
  const double w_x = sight.rate_per_s, w_y = c.side_rate_share * w_x, sign = side_of(1 - s.stance);
  const double grown_x = std::exp(w_x * c.step_s), grown_y = std::exp(w_y * c.step_s);
  s.meant.step = {(s.meant.velocity.forward_m_s + s.meant.trim_m_s.x_m) * c.step_s,
                  (s.meant.velocity.left_m_s + s.meant.trim_m_s.y_m) * c.step_s};
  s.meant.offset = {s.meant.step.x_m / (grown_x - 1) + c.shift_x_m,
                    s.meant.step.y_m / (grown_y - 1) - sign * c.width_m / (grown_y + 1)};
  s.meant.step.y_m += sign * c.width_m;
  if (s.kick.kicks()) {
    s.meant.step.x_m = s.kick.strike.x_m + c.kick.follow_m;
    return;
  }
  const GroundPoint from_next{kick.ball.x_m - s.meant.step.x_m, kick.ball.y_m - s.meant.step.y_m};
  const Kick next{from_next, kick.rad, kick.m_s};
  s.prepares = KickSwing::reaches(c.kick, next, -sign);
  if (!s.prepares) return;
  const double step_m = KickSwing::strike_of(c.kick, next).x_m + c.kick.follow_m,
               kick_s = KickSwing::step_s(c.kick, next);
  s.meant.offset = {c.shift_x_m + (step_m + s.meant.offset.x_m - c.shift_x_m) / std::exp(w_x * kick_s),
                    (-sign * c.width_m - s.meant.offset.y_m) / std::exp(w_y * kick_s)};
}

void WalkPlan::choose(const Config& c, const Sight& sight) noexcept {
  State& s = state_;
  const double w_x = sight.rate_per_s, w_y = c.side_rate_share * w_x, sign = side_of(1 - s.stance);
  const Kick& kick = s.kick.kick;
  const double wanted_s = s.kick.kicks() ? KickSwing::step_s(c.kick, kick) : c.step_s;
  const double least_s = s.kick.kicks() ? KickSwing::strike_s(c.kick, kick) + c.kick.after_s : c.step_min_s;
  const double earliest_s = std::max(least_s, s.time_s), latest_s = std::max({c.step_max_s, earliest_s, wanted_s});
  const double from_x_m = s.in_sole_x_m, from_y_m = c.edge_share * s.in_sole_y_m;
  // xi at the earliest time, and by how much it grows from one time to the next.
  const double apart_s = (latest_s - earliest_s) / (times_tried - 1), wait_s = earliest_s - s.time_s;
  GroundPoint ran{(s.dcm.x_m - from_x_m) * std::exp(w_x * wait_s), (s.dcm.y_m - from_y_m) * std::exp(w_y * wait_s)};
  const GroundPoint grows{std::exp(w_x * apart_s), std::exp(w_y * apart_s)};
  const double p = c.place_weight;
  const auto place = [&](const GroundPoint& dcm) {
    return GroundPoint{
        std::clamp((dcm.x_m - s.meant.offset.x_m + p * s.meant.step.x_m) / (1 + p), -c.reach_m, c.reach_m),
        sign * std::clamp(sign * (dcm.y_m - s.meant.offset.y_m + p * s.meant.step.y_m) / (1 + p), c.apart_min_m,
                          c.apart_max_m)};
  };
  std::array<double, times_tried> cost{};
  std::size_t best = 0;
  for (std::size_t i = 0; i < times_tried; ++i, ran = {ran.x_m * grows.x_m, ran.y_m * grows.y_m}) {
    const GroundPoint dcm{from_x_m + ran.x_m, from_y_m + ran.y_m}, at = place(dcm);
    const auto square = [](double v) { return v * v; };
    cost[i] = square(dcm.x_m - at.x_m - s.meant.offset.x_m) + square(dcm.y_m - at.y_m - s.meant.offset.y_m) +
              p * (square(at.x_m - s.meant.step.x_m) + square(at.y_m - s.meant.step.y_m)) +
              c.time_weight * square(earliest_s + static_cast<double>(i) * apart_s - wanted_s);
    if (cost[i] < cost[best]) best = i;
  }
  if (s.time_s < c.place_share * s.step_s) {  // then the foot comes straight down
    const double beyond = best == 0 || best == times_tried - 1 ? 0 : lowest(cost[best - 1], cost[best], cost[best + 1]);
    s.step_s = earliest_s + (static_cast<double>(best) + beyond) * apart_s;
    const double left_s = s.step_s - s.time_s;
    s.feet.foothold = place({from_x_m + (s.dcm.x_m - from_x_m) * std::exp(w_x * left_s),
                             from_y_m + (s.dcm.y_m - from_y_m) * std::exp(w_y * left_s)});
  }
  // The pressure goes beyond xi where xi is ahead of what was meant.
  const double begun_x_m = s.kick.kicks() ? s.meant.begun_x_m : s.meant.offset.x_m;
  const double meant_x_m = begun_x_m * std::exp(w_x * std::min(s.time_s, wanted_s));
  s.in_sole_x_m = std::clamp(c.shift_x_m + c.ankle_gain * (s.dcm.x_m - meant_x_m), -c.sole.heel_m, c.sole.toe_m);
}

void WalkPlan::lead_foot(const Config& c) noexcept {
  State& s = state_;
  const double share = s.time_s / s.step_s, way = swing_way(share / c.place_share);
  const double sink_m = c.sink_m_s * std::max(s.time_s - s.step_s, 0.0);
  if (s.kick.kicks()) {
    s.feet.at_m = s.kick.at(c.kick, s.feet.from_m, s.feet.foothold, s.time_s + c.kick.lead_s, s.step_s);
    s.feet.at_m[2] -= std::min(sink_m, 0.06);
    return;
  }
  s.feet.at_m = {s.feet.from_m[0] + way * (s.feet.foothold.x_m - s.feet.from_m[0]),
                 s.feet.from_m[1] + way * (s.feet.foothold.y_m - s.feet.from_m[1]),
                 s.feet.from_m[2] * (1 - way) + c.lift_m * swing_lift(share) - std::min(sink_m, 0.06)};
}

void WalkPlan::trim(const Config& c, const Sight& sight) noexcept {
  State& s = state_;
  const DcmMeasure::OverFoot& before = sight.over[1 - s.stance];  // of the foot that stood
  const double time_s = std::max(step_time_s_, 0.1);
  const auto corrected = [&](double trim_m_s, double meant_m_s, double way_m) {
    const double missed_m_s = meant_m_s - way_m / time_s;
    return std::clamp(trim_m_s + c.trim_per_s * time_s * missed_m_s, -c.trim_max_m_s, c.trim_max_m_s);
  };
  s.meant.trim_m_s = {corrected(s.meant.trim_m_s.x_m, s.meant.velocity.forward_m_s, before.com_m[0] - from_com_m_.x_m),
                      corrected(s.meant.trim_m_s.y_m, s.meant.velocity.left_m_s, before.com_m[1] - from_com_m_.y_m)};
}

void WalkPlan::land(const Config& c, const Wanted& wanted, const Sight& sight) noexcept {
  State& s = state_;
  const Vec3 &a = sight.over[s.stance].foot_m, &b = sight.over[1 - s.stance].foot_m;
  const GroundPoint way{b[0] - a[0], b[1] - a[1]};
  step_time_s_ = s.time_s;
  s.stance = 1 - s.stance;
  s.in_sole_y_m = 0;
  s.touchdown = {};
  trim(c, sight);
  s.dcm = {s.dcm.x_m - way.x_m, s.dcm.y_m - way.y_m};
  leave(sight);
  from_com_m_ = {sight.over[s.stance].com_m[0], sight.over[s.stance].com_m[1]};
  s.meant.begun_x_m = s.meant.offset.x_m;
  ++s.steps;
  s.kicks += s.kick.kicks();
  s.kick.end();
  s.time_s = 0;
  s.step_s = c.step_s;
  // As long as the last step took: steps land sooner than meant, and the rate is that of time.
  s.meant.turn_rad = s.meant.velocity.turn_rad_s * std::min(step_time_s_, c.step_max_s);
  const double slow_m_s = 0.06, beside_m = 0.1;
  if (!wanted.go && std::abs(s.meant.velocity.forward_m_s) < slow_m_s &&
      std::abs(s.meant.velocity.left_m_s) < slow_m_s && s.steps > 1 && std::abs(way.x_m) < beside_m &&
      between_feet(c, sight, stop_share))
    s.phase = Phase::bears;
  if (sight.sunk_m > c.sunk_m && between_feet(c, sight, safe_share)) s.phase = Phase::rests;
}

// Whether xi is between the feet, or over this share of a sole before or behind them.
bool WalkPlan::between_feet(const Config& c, const Sight& sight, double share) const noexcept {
  const State& s = state_;
  const Vec3 &a = sight.over[s.stance].foot_m, &b = sight.over[1 - s.stance].foot_m;
  const GroundPoint other{b[0] - a[0], b[1] - a[1]};
  return s.dcm.x_m > std::min(other.x_m, 0.0) - share * c.sole.heel_m &&
         s.dcm.x_m < std::max(other.x_m, 0.0) + share * c.sole.toe_m &&
         s.dcm.y_m > std::min(other.y_m, 0.0) - c.sole.half_width_m &&
         s.dcm.y_m < std::max(other.y_m, 0.0) + c.sole.half_width_m;
}

// It steps on when it is up and xi in the middle, and when that takes too long.
void WalkPlan::rest(const Config& c, const Wanted& wanted, const Sight& sight) noexcept {
  State& s = state_;
  const GroundPoint to = goal(c, sight);
  const bool up = sight.sunk_m < up_share * c.sunk_m,
             still = std::hypot(s.dcm.x_m - to.x_m, s.dcm.y_m - to.y_m) < still_m;
  if (!(up && still) && s.time_s < c.rest_s) return;
  s.phase = Phase::bears;
  s.time_s = 0;
  if (wanted.go) sway(c, sight);
}

bool WalkPlan::advance(const Config& c, const Wanted& wanted, const Sight& sight, double dt_s) noexcept {
  State& s = state_;
  if (s.phase == Phase::stands) return false;
  s.time_s += dt_s;
  follow_wanted(c, wanted, dt_s);
  look(c, sight, dt_s);
  if (s.phase == Phase::bears || s.phase == Phase::rests) {
    if (!between_feet(c, sight, held_share)) return step_out(c, sight);
    if (s.phase == Phase::rests) rest(c, wanted, sight);
    return false;
  }
  if (s.phase == Phase::sways) return swayed(c, sight);
  if (s.prepares && s.time_s < 1.5 * dt_s && KickSwing::reaches(c.kick, wanted.kick, side_of(1 - s.stance)))
    s.kick.begin(c.kick, wanted.kick);
  s.prepares = false;
  mean(c, sight, wanted.kick);
  choose(c, sight);
  lead_foot(c);
  const double early_s =
      s.kick.kicks() ? KickSwing::strike_s(c.kick, s.kick.kick) + 0.5 * c.kick.after_s : c.early_share * s.step_s;
  s.touchdown.look(sight.force_N[1 - s.stance], c.touch_N, dt_s);
  const bool touches = s.time_s > early_s && s.touchdown.landed(c.touch_s);
  if (!touches && s.time_s < s.step_s + late_s) return false;
  land(c, wanted, sight);
  return true;
}

double WalkPlan::other_yaw_rad(const Config& c) const noexcept {
  const State& s = state_;
  const double turn_rad = s.meant.turn_rad * swing_way(s.time_s / s.step_s);
  return s.kick.kicks() ? turn_rad + s.kick.yaw_rad(c.kick, s.time_s + c.kick.lead_s) : turn_rad;
}

void WalkPlan::turned(double by_rad) noexcept {
  State& s = state_;
  const double c = std::cos(by_rad), n = std::sin(by_rad);
  const auto turn = [&](double& x, double& y) {
    const double was = x;
    x = c * was + n * y;
    y = c * y - n * was;
  };
  turn(s.dcm.x_m, s.dcm.y_m);
  turn(s.feet.from_m[0], s.feet.from_m[1]);
  turn(s.feet.at_m[0], s.feet.at_m[1]);
  turn(from_com_m_.x_m, from_com_m_.y_m);
}

}  // namespace kadans
