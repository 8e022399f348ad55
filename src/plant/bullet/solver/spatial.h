// Spatial vectors and rigid-body inertia in world axes about one common origin, so that no change of frame is needed.
// Featherstone, Rigid Body Dynamics Algorithms (RBDA), chapter 2. Units: rad, m, s, kg, N.
#pragma once

#include <LinearMath/btTransform.h>

namespace kadans::bullet {

struct Motion {  // velocity or acceleration of the body's point at the origin
  btVector3 angular{0, 0, 0}, linear{0, 0, 0};
};

struct Wrench {  // moment about the origin, and force
  btVector3 moment{0, 0, 0}, force{0, 0, 0};
};

inline Motion operator+(const Motion& a, const Motion& b) { return {a.angular + b.angular, a.linear + b.linear}; }
inline Motion operator*(const Motion& m, btScalar s) { return {m.angular * s, m.linear * s}; }
inline Wrench operator+(const Wrench& a, const Wrench& b) { return {a.moment + b.moment, a.force + b.force}; }
inline Wrench operator-(const Wrench& a, const Wrench& b) { return {a.moment - b.moment, a.force - b.force}; }
inline btScalar dot(const Motion& m, const Wrench& w) { return m.angular.dot(w.moment) + m.linear.dot(w.force); }

inline Wrench wrench_at(const btVector3& point_m, const btVector3& force) { return {point_m.cross(force), force}; }

// The rate of change of a motion vector that moves with a body of velocity v (RBDA 2.31), and of a wrench (RBDA 2.32).
inline Motion carried(const Motion& v, const Motion& m) {
  return {v.angular.cross(m.angular), v.angular.cross(m.linear) + v.linear.cross(m.angular)};
}
inline Wrench carried(const Motion& v, const Wrench& w) {
  return {v.angular.cross(w.moment) + v.linear.cross(w.force), v.angular.cross(w.force)};
}

// Mass, first moment m c, and the six different entries of the rotational inertia about the origin (RBDA 2.63).
struct SpatialInertia {
  btScalar mass_kg = 0;
  btVector3 moment_kg_m{0, 0, 0};
  btScalar xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  SpatialInertia& operator+=(const SpatialInertia& other) {
    mass_kg += other.mass_kg;
    moment_kg_m += other.moment_kg_m;
    xx += other.xx, yy += other.yy, zz += other.zz;
    xy += other.xy, xz += other.xz, yz += other.yz;
    return *this;
  }

  btVector3 turned(const btVector3& w) const {
    return {xx * w.x() + xy * w.y() + xz * w.z(), xy * w.x() + yy * w.y() + yz * w.z(),
            xz * w.x() + yz * w.y() + zz * w.z()};
  }

  Wrench operator*(const Motion& m) const {
    return {turned(m.angular) + moment_kg_m.cross(m.linear), mass_kg * m.linear - moment_kg_m.cross(m.angular)};
  }
};

// Of a body with these principal moments about its centre of mass, which is at `com_m` and turned by `axes`.
inline SpatialInertia spatial_inertia(btScalar mass_kg, const btVector3& moments_kg_m2, const btMatrix3x3& axes,
                                      const btVector3& com_m) {
  const btVector3 c = com_m * mass_kg;
  const btVector3 rows[3] = {axes[0] * moments_kg_m2, axes[1] * moments_kg_m2, axes[2] * moments_kg_m2};
  return {mass_kg,
          c,
          rows[0].dot(axes[0]) + c.y() * com_m.y() + c.z() * com_m.z(),
          rows[1].dot(axes[1]) + c.x() * com_m.x() + c.z() * com_m.z(),
          rows[2].dot(axes[2]) + c.x() * com_m.x() + c.y() * com_m.y(),
          rows[0].dot(axes[1]) - c.x() * com_m.y(),
          rows[0].dot(axes[2]) - c.x() * com_m.z(),
          rows[1].dot(axes[2]) - c.y() * com_m.z()};
}

}  // namespace kadans::bullet
