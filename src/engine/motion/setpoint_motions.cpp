#include "setpoint_motions.h"

#include <algorithm>
#include <cmath>

#include "kadans/control/takeover.h"

namespace kadans {

void CubicSpline::begin(double value, double velocity) noexcept {
  knots_[0] = {value, velocity, 0};
  count_ = 0;
  duration_s_ = 0;
}

bool CubicSpline::add(double value, double duration_s) noexcept {
  if (count_ == points_max || !(duration_s > 0)) return false;
  knots_[++count_] = {value, 0, duration_s};
  duration_s_ += duration_s;
  return true;
}

// A tridiagonal system for the velocities between the ends, solved by elimination (Thomas).
void CubicSpline::plan() noexcept {
  std::array<double, points_max + 1> upper{};
  for (std::size_t i = 1; i < count_; ++i) {
    const double before = 1 / knots_[i].duration_s, after = 1 / knots_[i + 1].duration_s;
    const double slopes = 3 * ((knots_[i].value - knots_[i - 1].value) * before * before +
                               (knots_[i + 1].value - knots_[i].value) * after * after);
    const double pivot = 2 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    knots_[i].velocity = (slopes - before * knots_[i - 1].velocity) / pivot;
  }
  for (std::size_t i = count_; i-- > 1;) knots_[i].velocity -= upper[i] * knots_[i + 1].velocity;
}

SetpointState CubicSpline::inside(std::size_t segment, double time_s) const noexcept {
  const Knot& from = knots_[segment];
  const Knot& to = knots_[segment + 1];
  const double T = to.duration_s, t = time_s / T, way = to.value - from.value;
  const double c1 = from.velocity * T, c2 = 3 * way - (2 * from.velocity + to.velocity) * T;
  const double c3 = (from.velocity + to.velocity) * T - 2 * way;
  return {from.value + t * (c1 + t * (c2 + t * c3)), (c1 + t * (2 * c2 + t * 3 * c3)) / T,
          (2 * c2 + 6 * c3 * t) / T / T};
}

SetpointState CubicSpline::at(double time_s) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (time_s < knots_[i + 1].duration_s) return inside(i, time_s);
    time_s -= knots_[i + 1].duration_s;
  }
  return {knots_[count_].value, 0, 0};
}

// At the points, and where the velocity is 0 between them.
CubicSpline::Range CubicSpline::range() const noexcept {
  Range range{knots_[0].value, knots_[0].value};
  const auto include = [&](double value) { range = {std::min(range.lowest, value), std::max(range.highest, value)}; };
  for (std::size_t i = 0; i < count_; ++i) {
    include(knots_[i + 1].value);
    const double T = knots_[i + 1].duration_s;
    const double start = knots_[i].velocity, end = knots_[i + 1].velocity;
    const double mean = (knots_[i + 1].value - knots_[i].value) / T;
    const double a = 3 * (start + end - 2 * mean), b = 2 * (3 * mean - 2 * start - end), c = start;
    const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
    const double q = -0.5 * (b + (b < 0 ? -root : root));  // no cancellation
    for (const double t : {q / a, c / q}) {
      if (t > 0 && t < 1) include(inside(i, t * T).value);
    }
  }
  return range;
}

SetpointMotions::SetpointMotions(Catalog& catalog, ControlSets& sets)
    : setpoints_(catalog.setpoints), sets_(sets), motions_(catalog.setpoints.size()) {
  active_.reserve(motions_.size());
  for (SetpointId id = 0; id < std::min(motions_.size(), max_setpoints_shown); ++id)
    shown_.push_back({setpoints_[id].follows ? &object(id) : nullptr, setpoints_[id].owner, setpoints_[id].channel});
}

bool SetpointMotions::acceptable(const Command& command, const SetpointTable& setpoints) noexcept {
  if (!setpoints.accepts(command.index, command.value) || !setpoints[command.index].follows) return false;
  if (!(command.duration_s >= 0 && command.duration_s <= motion_duration_max_s)) return false;
  if (command.kind == CommandKind::via_point) {
    return command.duration_s > 0 && command.count < CubicSpline::points_max;
  }
  return command.velocity > 0 && std::isfinite(command.velocity) && command.acceleration > 0 &&
         std::isfinite(command.acceleration);
}

SetpointState SetpointMotions::now(SetpointId id) const noexcept {
  SetpointState state;
  (void)object(id).setpoint_state(setpoints_[id].channel, state);
  return state;
}

MotionProfile SetpointMotions::profile(const SetpointState& from, double target, double velocity_max,
                                       double acceleration_max, double duration_s) noexcept {
  const double rounding_s = duration_s > 0 ? std::min(corner_s, 0.1 * duration_s) : corner_s;
  MotionProfile profile;
  profile.set_state(from);
  (void)profile.move(target, {velocity_max, acceleration_max, acceleration_max / rounding_s}, duration_s);
  return profile;
}

SetpointMotions::Motion& SetpointMotions::activate(SetpointId id) noexcept {
  Motion& motion = motions_[id];
  if (motion.kind == Motion::Kind::none) active_.push_back(id);
  return motion;
}

void SetpointMotions::lead(SetpointId id) noexcept {
  const SetpointState from = now(id);
  Motion& motion = activate(id);
  motion.kind = Motion::Kind::minimum_jerk;
  motion.minimum_jerk.follow(from);
  object(id).follow(setpoints_[id].channel, from);  // ends the motion by which it comes to rest after its start
  motion.led = true;
  motion.told = from;
}

void SetpointMotions::move(SetpointId id, double value, double duration_s) noexcept {
  const Setpoint& setpoint = setpoints_[id];
  if (!setpoint.follows || setpoint.own_motion || !(duration_s > 0)) {
    drop(id);
    if (setpoint.follows && !setpoint.own_motion) return object(id).follow(setpoint.channel, {.value = value});
    return object(id).set_point(setpoint.channel, value, duration_s);
  }
  if (!sets_.runs(setpoint.owner)) return;  // it will start where its joints are
  lead(id);
  motions_[id].minimum_jerk.move(value, duration_s);
}

void SetpointMotions::cancel(SetpointId id) noexcept {
  const Setpoint& setpoint = setpoints_[id];
  if (!setpoint.follows || setpoint.own_motion) {
    drop(id);
    return object(id).cancel_motion(setpoint.channel);
  }
  const double velocity = now(id).velocity;
  if (!sets_.runs(setpoint.owner) || (motions_[id].kind == Motion::Kind::none && velocity == 0)) return;
  lead(id);
  motions_[id].minimum_jerk.move(now(id).value + 0.5 * cancel_time_s * velocity, cancel_time_s);
}

void SetpointMotions::begin(const Command& command) noexcept {
  if (!sets_.runs(setpoints_[command.index].owner)) return;  // it will start where its joints are
  Motion& motion = activate(command.index);
  if (command.kind == CommandKind::trapezoid) {
    motion.kind = Motion::Kind::trapezoid;
    motion.led = false;
    motion.trapezoid =
        profile(now(command.index), command.value, command.velocity, command.acceleration, command.duration_s);
    return;
  }
  if (command.count == 0 || motion.kind != Motion::Kind::spline) {
    const SetpointState from = now(command.index);
    motion.spline.begin(from.value, from.velocity);
    motion.time_s = 0;
    motion.led = false;
  }
  motion.kind = Motion::Kind::spline;
  motion.planned = false;
  (void)motion.spline.add(command.value, command.duration_s);
}

void SetpointMotions::drop(SetpointId id) noexcept {
  if (motions_[id].kind == Motion::Kind::none) return;
  motions_[id].kind = Motion::Kind::none;
  active_.erase(std::find(active_.begin(), active_.end(), id));
}

bool SetpointMotions::still_led(SetpointId id) const noexcept {
  const Motion& motion = motions_[id];
  if (!sets_.runs(setpoints_[id].owner)) return false;
  const SetpointState state = now(id);
  return !motion.led || (state.value == motion.told.value && state.velocity == motion.told.velocity);
}

SetpointState SetpointMotions::advance(Motion& motion, double dt_s) noexcept {
  if (motion.kind == Motion::Kind::minimum_jerk) return motion.minimum_jerk.step(dt_s);
  if (motion.kind == Motion::Kind::trapezoid) return motion.trapezoid.step(dt_s);
  if (!motion.planned) motion.spline.plan();
  motion.planned = true;
  motion.time_s += dt_s;
  return motion.spline.at(motion.time_s);
}

double SetpointMotions::remaining_s(const Motion& motion) noexcept {
  if (motion.kind == Motion::Kind::minimum_jerk) return motion.minimum_jerk.remaining_s();
  if (motion.kind == Motion::Kind::trapezoid) return motion.trapezoid.remaining_s();
  return std::max(0.0, motion.spline.duration_s() - motion.time_s);
}

void SetpointMotions::step(double dt_s) noexcept {
  std::erase_if(active_, [&](SetpointId id) {
    Motion& motion = motions_[id];
    // In the tick of its start an object passes no time.
    if (motion.kind == Motion::Kind::minimum_jerk && sets_.fresh(setpoints_[id].owner)) return false;
    bool over = !still_led(id);
    if (!over) {
      motion.led = true;
      motion.told = advance(motion, dt_s);
      object(id).follow(setpoints_[id].channel, motion.told);
      over = !(remaining_s(motion) > 0);
    }
    if (over) motion.kind = Motion::Kind::none;
    return over;
  });
}

double SetpointMotions::remaining_s(std::uint32_t owner) const noexcept {
  double left_s = sets_.object(owner).motion_remaining_s();
  for (const SetpointId id : active_) {
    if (setpoints_[id].owner == owner) left_s = std::max(left_s, remaining_s(motions_[id]));
  }
  return left_s;
}

// In the order in which they began.
void SetpointMotions::pass_state(StateBytes& bytes) noexcept {
  auto count = static_cast<std::uint32_t>(bytes.measures() ? motions_.size() : active_.size());
  bytes(count);
  bytes.must(count <= motions_.size());
  if (!bytes.ok()) return;
  if (bytes.restores()) {
    for (Motion& motion : motions_) motion.kind = Motion::Kind::none;
    active_.clear();
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    SetpointId id = bytes.restores() ? 0 : bytes.measures() ? i : active_[i];
    bytes(id);
    bytes.must(id < motions_.size() && motions_[id].kind == Motion::Kind::none && setpoints_[id].follows);
    if (!bytes.ok()) return;
    Motion& motion = motions_[id];
    bytes(motion.kind, motion.led, motion.told, motion.planned, motion.time_s);
    bytes(motion.minimum_jerk, motion.trapezoid, motion.spline);
    bytes.must(motion.kind != Motion::Kind::none && motion.kind <= Motion::Kind::spline);
    if (bytes.restores()) active_.push_back(id);
  }
}

void SetpointMotions::fill(Snapshot& snapshot) const noexcept {
  snapshot.setpoint_count = static_cast<std::uint32_t>(shown_.size());
  SetpointStatus* status = snapshot.setpoints.data();
  const ControlObject* last = nullptr;
  bool runs = false;
  for (const Shown& shown : shown_) {
    SetpointStatus& at = *status++;
    if (shown.object != last) {  // an object's set-points stand together
      last = shown.object;
      runs = last != nullptr && sets_.runs(shown.owner);
    }
    if (!runs) {
      at = {};
      continue;
    }
    SetpointState state;
    (void)shown.object->setpoint_state(shown.channel, state);
    at = {state.value, state.velocity};
  }
  for (const SetpointId id : active_) {
    double& left_s = snapshot.objects[setpoints_[id].owner].motion_remaining_s;
    left_s = std::max(left_s, remaining_s(motions_[id]));
  }
}

}  // namespace kadans
