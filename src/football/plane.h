// Points and poses on the ground. Angles count from x toward y.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kadans::football {

struct Point {
  double x_m = 0, y_m = 0;

  friend Point operator+(const Point& a, const Point& b) noexcept { return {a.x_m + b.x_m, a.y_m + b.y_m}; }
  friend Point operator-(const Point& a, const Point& b) noexcept { return {a.x_m - b.x_m, a.y_m - b.y_m}; }
  friend Point operator*(double factor, const Point& a) noexcept { return {factor * a.x_m, factor * a.y_m}; }
  friend bool operator==(const Point&, const Point&) = default;
};

struct Pose2 {
  double x_m = 0, y_m = 0, theta_rad = 0;

  Point at() const noexcept { return {x_m, y_m}; }
  friend bool operator==(const Pose2&, const Pose2&) = default;
};

inline double dot(const Point& a, const Point& b) noexcept { return a.x_m * b.x_m + a.y_m * b.y_m; }
inline double norm(const Point& a) noexcept { return std::sqrt(dot(a, a)); }
inline double distance(const Point& a, const Point& b) noexcept { return norm(a - b); }
inline bool finite(const Point& a) noexcept { return std::isfinite(a.x_m) && std::isfinite(a.y_m); }
inline bool finite(const Pose2& a) noexcept { return finite(a.at()) && std::isfinite(a.theta_rad); }

inline Point turned(const Point& a, double angle_rad) noexcept {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * a.x_m - s * a.y_m, s * a.x_m + c * a.y_m};
}

// Within [-pi, pi).
inline double wrapped(double angle_rad) noexcept {
  constexpr double turn_rad = 2 * std::numbers::pi;
  const double rest_rad = std::fmod(angle_rad + std::numbers::pi, turn_rad);
  return (rest_rad < 0 ? rest_rad + turn_rad : rest_rad) - std::numbers::pi;
}

// A point, or a pose, that is given in the frame of `pose`.
inline Point from_frame(const Pose2& pose, const Point& point) noexcept {
  return pose.at() + turned(point, pose.theta_rad);
}
inline Pose2 from_frame(const Pose2& frame, const Pose2& pose) noexcept {
  const Point at = from_frame(frame, pose.at());
  return {at.x_m, at.y_m, wrapped(frame.theta_rad + pose.theta_rad)};
}
// The same, seen from `frame`.
inline Point in_frame(const Pose2& frame, const Point& point) noexcept {
  return turned(point - frame.at(), -frame.theta_rad);
}
inline Pose2 in_frame(const Pose2& frame, const Pose2& pose) noexcept {
  const Point at = in_frame(frame, pose.at());
  return {at.x_m, at.y_m, wrapped(pose.theta_rad - frame.theta_rad)};
}

// The field looks the same from its other end.
inline Point mirrored(const Point& point) noexcept { return {-point.x_m, -point.y_m}; }
inline Pose2 mirrored(const Pose2& pose) noexcept {
  return {-pose.x_m, -pose.y_m, wrapped(pose.theta_rad + std::numbers::pi)};
}

}  // namespace kadans::football
