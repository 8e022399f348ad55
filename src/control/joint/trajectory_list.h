// A list of via points for each joint, followed by a PID in effort mode: type "trajectory_list". Behaviors fill the
// list by set-points with durations, a high level in C++ by append(). The low level fetches a point when it has reached
// the one before; it never waits.
//
// Two points are joined by a cubic Hermite polynomial. A point without a velocity gets one from its neighbours, so that
// the motion is monotone between points (Fritsch and Carlson 1980, SIAM J. Numer. Anal. 17(2)): 0 where the direction
// turns, and 0 at the last point. So the reference stays between the two points around it. A point that arrives while
// the motion goes to the last one still changes the velocity at that last one.
//
// Set-points  <joint>.position_rad. With append = 1 a set-point is added to the list; its duration counts from the
//             point before. With append = 0 it replaces the rest of the list. A duration of 0 acts at once.
// Underrun    a point announced another one (ViaPoint::more), and none has come when it is reached. The reference comes
//             to rest, the signal underrun stays set until the next point, and underruns counts it.
// Refused     a point for which there is no room, or which is not acceptable. The signal dropped counts the refused
//             set-points.
// Threads     append() belongs to the behavior thread, all else to the control thread.
#pragma once

#include <limits>
#include <memory>

#include "kadans/control/jointwise.h"
#include "kadans/control/pid.h"
#include "kadans/exchange/ring.h"

namespace kadans {

struct ViaPoint {
  static constexpr double chosen = std::numeric_limits<double>::quiet_NaN();

  double position_rad = 0;
  double velocity_rad_s = chosen;  // a finite value: the velocity at the point
  double duration_s = 0;           // after the point before; at least duration_min_s
  bool more = false;               // the writer will add another point in time

  static constexpr double duration_min_s = 0.001;
};

class TrajectoryLaw {
 public:
  struct State {
    std::uint32_t waiting = 0;  // points in the list, without the one under way
    std::uint32_t underruns = 0;
    std::uint32_t dropped = 0;
    bool underrun = false;
  };
  static constexpr std::uint32_t channels = 1;
  static constexpr std::size_t capacity = 64;

  explicit TrajectoryLaw(const JointAxis& axis) : axis_(axis) {}
  void declare(AxisTables& tables);
  void start(const Takeover& takeover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void set_point(std::uint32_t which, double value, double duration_s) noexcept;
  void cancel(std::uint32_t which) noexcept;
  double remaining_s() const noexcept;
  void pass_state(StateBytes& bytes) noexcept {
    bytes(pid_, state_, segment_, reference_rad_, reference_rad_s_, commanded_);
    bytes.must(commanded_.size() <= capacity);
    bytes.high_level(handed_);
  }

  // Behavior thread. False, and nothing changes, when the list is full, the position is not within the joint's limits,
  // or the duration is too short.
  [[nodiscard]] bool append(const ViaPoint& point) noexcept;

 private:
  struct Segment {
    double from_rad = 0, from_rad_s = 0, to_rad = 0, to_rad_s = 0;
    double duration_s = 0, time_s = 0;
    bool moving = false;
    bool open = false;  // the end's velocity may still change
    bool more = false;
  };

  std::size_t waiting() const noexcept { return commanded_.size() + handed_.size(); }
  const ViaPoint& peek(std::size_t i) const noexcept;
  void drop_first() noexcept;
  void clear() noexcept;
  void fetch() noexcept;
  void stop() noexcept;
  void choose_end_velocity() noexcept;
  void advance(double dt_s) noexcept;
  void evaluate() noexcept;

  JointAxis axis_;
  Pid pid_;
  State state_;
  double append_ = 1;
  Segment segment_;
  double reference_rad_ = 0, reference_rad_s_ = 0;
  Ring<ViaPoint, capacity> commanded_;  // both ends in the control thread
  Ring<ViaPoint, capacity> handed_;     // from the behavior thread
};

// Derive from it and override update() for a high level of your own.
class TrajectoryList : public Jointwise<TrajectoryLaw> {
 public:
  using Jointwise::Jointwise;
  // Behavior thread; `i` as in ObjectSetup::joints. False as in TrajectoryLaw.
  [[nodiscard]] bool append(std::size_t i, const ViaPoint& point) noexcept { return law(i).append(point); }
};

std::unique_ptr<ControlObject> make_trajectory_list(const ObjectSetup& setup);

}  // namespace kadans
