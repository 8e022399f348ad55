// Plans motions of set-points above the control objects, so that every object has them: each tick the object is told
// where its set-point is. Some objects plan the way to a plain set-point themselves, because it is their law
// (Setpoint::own_motion, and those that cannot be led).
//
//   minimum jerk  of a plain set-point: to rest at the target in the time given (minimum_jerk.h)
//   trapezoid     speeds up, cruises and slows down within limits of velocity and acceleration (motion_profile.h). The
//                 corners are rounded over corner_s, so that no torque steps. The target may change while it runs.
//   spline        a curve through points at given times (CubicSpline)
//
// A motion begins with the present position and velocity of the set-point, so it replaces another motion without a
// jump. A motion that is cancelled comes to rest in cancel_time_s, after half the way that it would go at its present
// velocity. A motion is dropped when its object leaves the control set, or when the object has started anew and its
// set-point is no longer where it was led.
//
// One owner, the control thread; nothing here allocates after construction, locks or throws.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/control/control_sets.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/control/motion_profile.h"
#include "kadans/signal/command.h"
#include "kadans/signal/setpoint.h"

namespace kadans {

// A curve through points at given times: cubic polynomials between them, with velocity and acceleration continuous at
// every point, the velocity given at the start and 0 at the end (Biagiotti and Melchiorri, Trajectory Planning for
// Automatic Machines and Robots, Springer 2008, sec. 4.4.1). The curve overshoots points where the direction turns;
// range() says how far.
//
// A fixed number of points; nothing here allocates, locks or throws.
class CubicSpline {
 public:
  static constexpr std::size_t points_max = 16;

  void begin(double value, double velocity) noexcept;
  // False, and nothing changes, when there are points_max points already, or duration_s is not > 0.
  [[nodiscard]] bool add(double value, double duration_s) noexcept;
  // After the last point: finds the velocities.
  void plan() noexcept;

  struct Point {
    double value = 0, duration_s = 0;  // after the point before
  };
  Point point(std::size_t i) const noexcept { return {knots_[i + 1].value, knots_[i + 1].duration_s}; }
  std::size_t size() const noexcept { return count_; }
  double duration_s() const noexcept { return duration_s_; }
  SetpointState at(double time_s) const noexcept;  // at rest at the last point from its time on
  struct Range {
    double lowest = 0, highest = 0;
  };
  Range range() const noexcept;
  void pass_state(auto& bytes) noexcept {
    bytes(knots_, count_, duration_s_);
    bytes.must(count_ <= points_max);
  }

 private:
  struct Knot {
    double value = 0, velocity = 0;
    double duration_s = 0;  // after the knot before
  };
  SetpointState inside(std::size_t segment, double time_s) const noexcept;

  std::array<Knot, points_max + 1> knots_{};  // the start first
  std::size_t count_ = 0;                     // points, the start not among them
  double duration_s_ = 0;
};

class SetpointMotions {
 public:
  // For the set-points that `sets` marked in the catalog as ones that can be led.
  SetpointMotions(Catalog& catalog, ControlSets& sets);

  // Whether a command may be given to begin: a known set-point that can be led, limits and durations in their ranges.
  static bool acceptable(const Command& command, const SetpointTable& setpoints) noexcept;
  void begin(const Command& command) noexcept;  // trapezoid or via_point
  // A plain set-point, in its range; a duration of 0 acts at once.
  void move(SetpointId id, double value, double duration_s) noexcept;
  void cancel(SetpointId id) noexcept;
  // Each tick, after the commands and before the objects.
  void step(double dt_s) noexcept;
  // Between ticks: all that changes from tick to tick (kadans/control/state_bytes.h), of the motions under way.
  void pass_state(StateBytes& bytes) noexcept;
  // Writes into the snapshot where all set-points are, and how long their objects still move.
  void fill(Snapshot& snapshot) const noexcept;
  // Until the last set-point of the object is reached, motions of its own among them.
  double remaining_s(std::uint32_t object) const noexcept;

  // The motion of a trapezoid with these limits; a duration of 0 is as fast as they allow.
  static MotionProfile profile(const SetpointState& from, double target, double velocity_max, double acceleration_max,
                               double duration_s) noexcept;
  static constexpr double corner_s = 0.01;  // at most a tenth of the duration

 private:
  struct Motion {
    enum class Kind : std::uint8_t { none, minimum_jerk, trapezoid, spline };
    Kind kind = Kind::none;
    bool led = false;      // the object has been led since the motion began
    SetpointState told;    // where it was led to
    bool planned = false;  // of a spline: plan() was called after its last point
    double time_s = 0;     // of a spline
    MinimumJerk minimum_jerk;
    MotionProfile trapezoid;
    CubicSpline spline;
  };
  ControlObject& object(SetpointId id) const noexcept { return sets_.object(setpoints_[id].owner); }
  SetpointState now(SetpointId id) const noexcept;
  Motion& activate(SetpointId id) noexcept;
  void lead(SetpointId id) noexcept;  // minimum_jerk from now on
  void drop(SetpointId id) noexcept;
  bool still_led(SetpointId id) const noexcept;
  static SetpointState advance(Motion& motion, double dt_s) noexcept;
  static double remaining_s(const Motion& motion) noexcept;

  struct Shown {
    const ControlObject* object;  // null: it cannot be led
    std::uint32_t owner, channel;
  };

  const SetpointTable& setpoints_;
  ControlSets& sets_;
  std::vector<Motion> motions_;     // by SetpointId
  std::vector<Shown> shown_;        // likewise: those in the snapshot
  std::vector<SetpointId> active_;  // those under way
};

}  // namespace kadans
