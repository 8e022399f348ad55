#include "touch_points.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>

namespace kadans::bullet {
namespace {

struct Nearest {
  btVector3 point, normal;  // of a surface, outwards
  double distance_m = 0;    // of what was asked about; negative inside
};

Nearest nearest_on_box(const btVector3& half_m, const btVector3& point) {
  btVector3 on = point;
  on.setMax(-half_m);
  on.setMin(half_m);
  const btVector3 out = point - on;
  const double distance = out.length();
  if (distance > 1e-12) return {on, out / distance, distance};
  const btVector3 room = half_m - point.absolute();
  const int axis = room.minAxis();
  btVector3 normal(0, 0, 0);
  normal[axis] = point[axis] < 0 ? -1 : 1;
  return {point + room[axis] * normal, normal, -room[axis]};
}

Nearest nearest_on_cylinder(double radius_m, double half_length_m, const btVector3& point) {
  const double from_axis = std::hypot(point.x(), point.y());
  const btVector3 radial =
      from_axis > 1e-12 ? btVector3(point.x() / from_axis, point.y() / from_axis, 0) : btVector3(1, 0, 0);
  const Nearest flat = nearest_on_box({radius_m, radius_m, half_length_m}, {from_axis, 0, point.z()});
  const auto turned = [&](const btVector3& v) { return v.x() * radial + btVector3(0, 0, v.z()); };
  if (flat.normal.y() == 0) return {turned(flat.point), turned(flat.normal), flat.distance_m};
  return {radius_m * radial + btVector3(0, 0, point.z()), radial, from_axis - radius_m};  // on the axis
}

Nearest nearest(const btConvexShape& shape, const btVector3& point) {
  if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) {
    return nearest_on_box(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin(), point);
  }
  if (shape.getShapeType() == CYLINDER_SHAPE_PROXYTYPE) {
    const btVector3 half_m = static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
    return nearest_on_cylinder(half_m.x(), half_m.z(), point);
  }
  const double radius_m = static_cast<const btSphereShape&>(shape).getRadius();
  const double distance = point.length();
  const btVector3 normal = distance > 1e-12 ? point / distance : btVector3(0, 0, 1);
  return {radius_m * normal, normal, distance - radius_m};
}

TouchPoints touch_sphere(const btSphereShape& a, const btVector3& center, const btConvexShape& b,
                         const btTransform& pose_b) {
  const Nearest on_b = nearest(b, pose_b.invXform(center));
  TouchPoints points;
  const double distance = on_b.distance_m - a.getRadius();
  if (!(distance < contact_distance_m)) return points;
  const btVector3 normal = pose_b.getBasis() * on_b.normal;
  points.add({center - a.getRadius() * normal, pose_b * on_b.point, normal, distance});
  return points;
}

TouchPoints swapped(TouchPoints points) {
  for (TouchPoint& point : points) {
    std::swap(point.on_a, point.on_b);
    point.normal = -point.normal;
  }
  return points;
}

// On each rim the nearest point to the face, the one across, and the two between; nearest rim first.
TouchPoints touch_rims(const btCylinderShape& a, const btTransform& pose_a, const PlacedBox& b) {
  const btVector3 half_m = a.getHalfExtentsWithMargin();
  const btVector3 center = b.pose.invXform(pose_a.getOrigin());
  const btMatrix3x3 turn = b.pose.getBasis().transposeTimes(pose_a.getBasis());
  int face = 0;
  double best_m = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double along = std::abs(turn[i].z());
    const double reach = half_m.z() * along + half_m.x() * std::sqrt(std::max(0.0, 1 - along * along));
    const double separation = std::abs(center[i]) - b.half_m[i] - reach;
    if (separation > best_m) best_m = separation, face = i;
  }
  btVector3 normal(0, 0, 0);
  normal[face] = center[face] < 0 ? -1 : 1;
  btVector3 down = -normal * turn;
  const double end = down.z() < 0 ? -1 : 1;
  down.setZ(0);
  down = down.length2() > 1e-12 ? down.normalized() : btVector3(1, 0, 0);
  const btVector3 side(-down.y(), down.x(), 0);
  TouchPoints points;
  for (const double rim : {end, -end}) {
    for (const btVector3& out : {down, side, -side, -down}) {
      const btVector3 at = center + turn * (half_m.x() * out + btVector3(0, 0, rim * half_m.z()));
      const double distance = normal[face] * at[face] - b.half_m[face];
      btVector3 over = at.absolute() - b.half_m;
      over[face] = 0;
      if (!(distance < contact_distance_m) || over[over.maxAxis()] > 0) continue;
      points.add({b.pose * at, b.pose * (at - distance * normal), b.pose.getBasis() * normal, distance});
    }
  }
  return points;
}

TouchPoints touch_nearest(const btConvexShape& a, const btTransform& pose_a, const btConvexShape& b,
                          const btTransform& pose_b) {
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth;
  btGjkPairDetector detector(&a, &b, &simplex, &depth);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = pose_a;
  input.m_transformB = pose_b;
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  TouchPoints points;
  if (!found.m_hasResult || !(found.m_distance < contact_distance_m)) return points;
  points.add({found.m_pointInWorld + found.m_distance * found.m_normalOnBInWorld, found.m_pointInWorld,
              found.m_normalOnBInWorld, found.m_distance});
  return points;
}

PlacedBox placed(const btConvexShape& box, const btTransform& pose) {
  return {pose, static_cast<const btBoxShape&>(box).getHalfExtentsWithMargin()};
}

}  // namespace

TouchPoints touch_points(const btConvexShape& a, const btTransform& pose_a, const btConvexShape& b,
                         const btTransform& pose_b) {
  const int type_a = a.getShapeType(), type_b = b.getShapeType();
  if (type_a == SPHERE_SHAPE_PROXYTYPE) {
    return touch_sphere(static_cast<const btSphereShape&>(a), pose_a.getOrigin(), b, pose_b);
  }
  if (type_b == SPHERE_SHAPE_PROXYTYPE) return swapped(touch_points(b, pose_b, a, pose_a));
  if (type_a == BOX_SHAPE_PROXYTYPE && type_b == BOX_SHAPE_PROXYTYPE) {
    return touch_boxes(placed(a, pose_a), placed(b, pose_b));
  }
  if (type_a == CYLINDER_SHAPE_PROXYTYPE && type_b == BOX_SHAPE_PROXYTYPE) {
    const TouchPoints rims = touch_rims(static_cast<const btCylinderShape&>(a), pose_a, placed(b, pose_b));
    return rims.size() > 0 ? rims : touch_nearest(a, pose_a, b, pose_b);
  }
  if (type_a == BOX_SHAPE_PROXYTYPE) return swapped(touch_points(b, pose_b, a, pose_a));
  return touch_nearest(a, pose_a, b, pose_b);
}

}  // namespace kadans::bullet
