#include "touch_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>

namespace kadans::bullet {
namespace {

struct PlacedBox {
  btTransform pose;
  btVector3 half_m;
};

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

constexpr double preference_m = 1e-3;  // another axis must be so much better than a face of the second box
constexpr double outline_m = 2e-4;     // faces are cut that much inside their outline: what only grazes a side is free

// The corners of a face in the other box's frame while they are cut, in order around it.
using Polygon = FixedList<btVector3, 8>;

struct Face {
  int axis = 0;
  double sign = 1;
  double separation_m = -std::numeric_limits<double>::infinity();
};

struct Edges {
  int axis_a = 0, axis_b = 0;
  btVector3 normal{0, 0, 0};  // from b to a
  double separation_m = -std::numeric_limits<double>::infinity();
};

double reach_m(const PlacedBox& box, const btVector3& direction) {
  double reach = 0;
  for (int i = 0; i < 3; ++i) reach += std::abs(direction.dot(box.pose.getBasis().getColumn(i))) * box.half_m[i];
  return reach;
}

// The face of `box` that looks at `other` with the least overlap.
Face best_face(const PlacedBox& box, const PlacedBox& other) {
  const btVector3 way = other.pose.getOrigin() - box.pose.getOrigin();
  Face best;
  for (int i = 0; i < 3; ++i) {
    const btVector3 axis = box.pose.getBasis().getColumn(i);
    const double along = way.dot(axis);
    const double separation = std::abs(along) - box.half_m[i] - reach_m(other, axis);
    if (separation > best.separation_m) best = {i, along < 0 ? -1.0 : 1.0, separation};
  }
  return best;
}

Edges best_edges(const PlacedBox& a, const PlacedBox& b) {
  const btVector3 way = a.pose.getOrigin() - b.pose.getOrigin();
  Edges best;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      btVector3 axis = a.pose.getBasis().getColumn(i).cross(b.pose.getBasis().getColumn(j));
      if (axis.length2() < 1e-6) continue;  // parallel edges: the faces say it better
      axis.normalize();
      if (way.dot(axis) < 0) axis = -axis;
      const double separation = way.dot(axis) - reach_m(a, axis) - reach_m(b, axis);
      if (separation > best.separation_m) best = {i, j, axis, separation};
    }
  }
  return best;
}

// Keeps what lies at or below `limit` along sign * axis.
Polygon cut(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const btVector3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double over_from = sign * from[axis] - limit, over_to = sign * to[axis] - limit;
    if (over_from <= 0) kept.add(from);
    if ((over_from <= 0) != (over_to <= 0)) kept.add(from + (to - from) * (over_from / (over_from - over_to)));
  }
  return kept;
}

// The face of `box` that looks most against `normal`, in the frame of `reference`.
Polygon facing(const PlacedBox& box, const btVector3& normal, const PlacedBox& reference) {
  const btVector3 local = normal * box.pose.getBasis();
  const int axis = local.absolute().maxAxis();
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const btTransform to_reference = reference.pose.inverseTimes(box.pose);
  Polygon polygon;
  for (const auto& [su, sv] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
    btVector3 corner;
    corner[axis] = local[axis] > 0 ? -box.half_m[axis] : box.half_m[axis];
    corner[u] = su * box.half_m[u];
    corner[v] = sv * box.half_m[v];
    polygon.add(to_reference * corner);
  }
  return polygon;
}

double inside(double half_m) { return std::max(half_m - outline_m, half_m / 2); }

// `incident` stands on a face of `reference`. The points of the incident box come first in each pair.
TouchPoints touch_face(const PlacedBox& reference, const Face& face, const PlacedBox& incident) {
  const btVector3 normal = face.sign * reference.pose.getBasis().getColumn(face.axis);
  Polygon polygon = facing(incident, normal, reference);
  for (const int side : {(face.axis + 1) % 3, (face.axis + 2) % 3}) {
    for (const double sign : {1.0, -1.0}) polygon = cut(polygon, side, sign, inside(reference.half_m[side]));
  }
  polygon = cut(polygon, face.axis, face.sign, reference.half_m[face.axis] + contact_distance_m);
  TouchPoints points;
  for (const std::size_t i : carrying(polygon, face.axis, face.sign)) {
    const double distance = face.sign * polygon[i][face.axis] - reference.half_m[face.axis];
    const btVector3 at = reference.pose * polygon[i];
    points.add({at, at - distance * normal, normal, distance});
  }
  return points;
}

// The middle of the edge of `box` along `axis` that reaches furthest in `direction`.
btVector3 edge_middle(const PlacedBox& box, int axis, const btVector3& direction) {
  btVector3 middle = box.pose.getOrigin();
  for (int i = 0; i < 3; ++i) {
    const btVector3 column = box.pose.getBasis().getColumn(i);
    if (i != axis) middle += (direction.dot(column) < 0 ? -1 : 1) * box.half_m[i] * column;
  }
  return middle;
}

TouchPoints touch_edges(const PlacedBox& a, const PlacedBox& b, const Edges& edges) {
  const btVector3 along_a = a.pose.getBasis().getColumn(edges.axis_a),
                  along_b = b.pose.getBasis().getColumn(edges.axis_b);
  const btVector3 from_a = edge_middle(a, edges.axis_a, -edges.normal),
                  from_b = edge_middle(b, edges.axis_b, edges.normal);
  const btVector3 way = from_a - from_b;
  const double cosine = along_a.dot(along_b), da = along_a.dot(way), db = along_b.dot(way);
  const double t_a = (cosine * db - da) / (1 - cosine * cosine), t_b = db + cosine * t_a;
  TouchPoints points;
  if (std::abs(t_a) > a.half_m[edges.axis_a] || std::abs(t_b) > b.half_m[edges.axis_b]) return points;
  points.add({from_a + t_a * along_a, from_b + t_b * along_b, edges.normal, edges.separation_m});
  return points;
}

TouchPoints touch_boxes(const PlacedBox& a, const PlacedBox& b) {
  const Face face_b = best_face(b, a), face_a = best_face(a, b);
  if (std::max(face_a.separation_m, face_b.separation_m) > contact_distance_m) return {};
  const Edges edges = best_edges(a, b);
  if (edges.separation_m > contact_distance_m) return {};
  const bool on_a = face_a.separation_m > face_b.separation_m + preference_m;
  const double face_m = on_a ? face_a.separation_m : face_b.separation_m;
  if (edges.separation_m > face_m + preference_m) return touch_edges(a, b, edges);
  return on_a ? swapped(touch_face(a, face_a, b)) : touch_face(b, face_b, a);
}

// The corners over the face of least overlap.
TouchPoints touch_corners(const btConvexHullShape& a, const btTransform& pose_a, const PlacedBox& b) {
  const btTransform to_b = b.pose.inverseTimes(pose_a);
  std::array<btVector3, hull_corners_max> near;
  const std::size_t all = std::min(near.size(), static_cast<std::size_t>(a.getNumPoints()));
  btVector3 low(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT), high = -low;
  for (std::size_t i = 0; i < all; ++i) {
    near[i] = to_b * a.getUnscaledPoints()[i];
    low.setMin(near[i]);
    high.setMax(near[i]);
  }
  Face face;
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [sign, end] : {std::pair{1.0, low[axis]}, std::pair{-1.0, -high[axis]}}) {
      const double separation = end - b.half_m[axis];
      if (separation > face.separation_m) face = {axis, sign, separation};
    }
  }
  const auto distance = [&](const btVector3& corner) { return face.sign * corner[face.axis] - b.half_m[face.axis]; };
  std::size_t count = 0;
  for (std::size_t i = 0; i < all; ++i) {
    btVector3 over = near[i].absolute() - b.half_m;
    over[face.axis] = 0;
    if (distance(near[i]) < contact_distance_m && over[over.maxAxis()] <= 0) near[count++] = near[i];
  }
  btVector3 normal(0, 0, 0);
  normal[face.axis] = face.sign;
  TouchPoints points;
  for (const std::size_t i : carrying(std::span(near).first(count), face.axis, face.sign)) {
    const double distance_m = distance(near[i]);
    points.add({b.pose * near[i], b.pose * (near[i] - distance_m * normal), b.pose.getBasis() * normal, distance_m});
  }
  return points;
}

bool is_hull(const btConvexShape& shape) { return shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE; }

}  // namespace

FixedList<std::size_t, TouchPoints::capacity> carrying(std::span<const btVector3> points, int axis, double sign) {
  FixedList<std::size_t, TouchPoints::capacity> kept;
  std::size_t deepest = 0, furthest = 0, left = 0, right = 0;
  const auto height = [&](std::size_t i) { return sign * points[i][axis]; };
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (height(i) < height(deepest)) deepest = i;
  }
  const auto distance2 = [&](std::size_t i) { return (points[i] - points[deepest]).length2(); };
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (distance2(i) > distance2(furthest)) furthest = i;
  }
  btVector3 normal(0, 0, 0);
  normal[axis] = 1;
  const btVector3 across = points.empty() ? normal : normal.cross(points[furthest] - points[deepest]);
  const auto aside = [&](std::size_t i) { return across.dot(points[i] - points[deepest]); };
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (aside(i) > aside(left)) left = i;
    if (aside(i) < aside(right)) right = i;
  }
  const bool all = points.size() <= TouchPoints::capacity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (all || i == deepest || i == furthest || i == left || i == right) kept.add(i);
  }
  return kept;
}

TouchPoints touch_points(const btConvexShape& a, const btTransform& pose_a, const btConvexShape& b,
                         const btTransform& pose_b) {
  const int type_a = a.getShapeType(), type_b = b.getShapeType();
  if (is_hull(a) && type_b == BOX_SHAPE_PROXYTYPE) {
    const TouchPoints corners = touch_corners(static_cast<const btConvexHullShape&>(a), pose_a, placed(b, pose_b));
    return corners.size() > 0 ? corners : touch_nearest(a, pose_a, b, pose_b);
  }
  if (is_hull(b) && type_a == BOX_SHAPE_PROXYTYPE) return swapped(touch_points(b, pose_b, a, pose_a));
  if (is_hull(a) || is_hull(b)) return touch_nearest(a, pose_a, b, pose_b);
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
