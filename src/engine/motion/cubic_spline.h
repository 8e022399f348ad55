// A curve through points at given times: cubic polynomials between them, with velocity and acceleration continuous at
// every point, the velocity given at the start and 0 at the end (Biagiotti and Melchiorri, Trajectory Planning for
// Automatic Machines and Robots, Springer 2008, sec. 4.4.1). The curve overshoots points where the direction turns;
// range() says how far.
//
// A fixed number of points; nothing here allocates, locks or throws.
#pragma once

#include <array>
#include <cstddef>

#include "kadans/signal/setpoint.h"

namespace kadans {

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

}  // namespace kadans
