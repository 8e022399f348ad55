// Between our plain vectors and Bullet's.
#pragma once

#include <cmath>

#include <LinearMath/btTransform.h>

#include "kadans/model/robot_model.h"

namespace kadans::bullet {

inline btVector3 to_bullet(const Vec3& v) { return {v[0], v[1], v[2]}; }
inline btQuaternion to_bullet(const Quat& q) { return {q[1], q[2], q[3], q[0]}; }
inline btTransform to_bullet(const Pose& pose) {
  return btTransform(to_bullet(pose.orientation), to_bullet(pose.position_m));
}

// Bullet counts links from the first moving one, the base being -1; the model counts the base as 0.
inline std::size_t model_link(int bullet_link) {
  const int link = bullet_link + 1;
  return static_cast<std::size_t>(link);
}

inline Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat from_bullet(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

inline Pose from_bullet(const btTransform& transform) {
  return {from_bullet(transform.getOrigin()), from_bullet(transform.getRotation())};
}

// About the world's z axis.
inline double heading_of(const btMatrix3x3& basis) { return std::atan2(basis[1][0], basis[0][0]); }

inline bool finite(const btVector3& v) { return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()); }

}  // namespace kadans::bullet
