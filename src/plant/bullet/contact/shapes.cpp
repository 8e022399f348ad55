#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "plant/bullet/convert.h"
#include "touch_points.h"

namespace kadans::bullet {

bool PairMask::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  const bool wanted = (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
                      (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0;
  if (!wanted) return false;
  const auto* link_a = btMultiBodyLinkCollider::upcast(static_cast<btCollisionObject*>(a->m_clientObject));
  const auto* link_b = btMultiBodyLinkCollider::upcast(static_cast<btCollisionObject*>(b->m_clientObject));
  if (link_a == nullptr || link_b == nullptr || link_a->m_multiBody != link_b->m_multiBody) return true;
  return allowed(model_link(link_a->m_link), model_link(link_b->m_link));
}

namespace {

constexpr double hull_margin_m = 5e-4;  // by which Bullet looks for contacts with all but ground and boxes

struct ConvexMaker {
  const Geometry& geometry;

  std::unique_ptr<btConvexShape> operator()(const Box& box) const {
    return std::make_unique<btBoxShape>(to_bullet(box.size_m) / 2);
  }
  std::unique_ptr<btConvexShape> operator()(const Sphere& sphere) const {
    return std::make_unique<btSphereShape>(sphere.radius_m);
  }
  std::unique_ptr<btConvexShape> operator()(const Cylinder& cylinder) const {
    return std::make_unique<btCylinderShapeZ>(btVector3(cylinder.radius_m, cylinder.radius_m, cylinder.length_m / 2));
  }
  std::unique_ptr<btConvexShape> operator()(const Mesh& mesh) const {
    const auto refuse = [&](const std::string& why) {
      throw std::invalid_argument("collision mesh '" + mesh.file + "' of link '" + geometry.link + "' " + why);
    };
    if (mesh.corners_m.empty()) refuse("was not read: the program kadans-hull, which reads meshes, is not installed");
    if (mesh.corners_m.size() > hull_corners_max)
      refuse("has a hull of " + std::to_string(mesh.corners_m.size()) + " corners; at most " +
             std::to_string(hull_corners_max));
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& corner : mesh.corners_m) hull->addPoint(to_bullet(corner), false);
    hull->setMargin(hull_margin_m);
    hull->recalcLocalAabb();
    return hull;
  }
};

void add_corners(const btConvexShape& shape, const btTransform& pose, std::vector<btVector3>& corners) {
  if (shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE) {
    const double radius_m = static_cast<const btSphereShape&>(shape).getRadius();
    corners.push_back(pose.getOrigin() - btVector3(0, 0, radius_m));
    return;
  }
  if (shape.getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE) {
    const auto& hull = static_cast<const btConvexHullShape&>(shape);
    for (int i = 0; i < hull.getNumPoints(); ++i) corners.push_back(pose * hull.getUnscaledPoints()[i]);
    return;
  }
  const bool box = shape.getShapeType() == BOX_SHAPE_PROXYTYPE;
  const btVector3 half_m = box ? static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin()
                               : static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
  const int around = box ? 4 : 16;
  const double reach = box ? std::sqrt(2.0) : 1;  // of a square's corners
  for (int i = 0; i < around; ++i) {
    const double angle_rad = (2 * i + 1) * std::numbers::pi / around;
    const btVector3 out(reach * std::cos(angle_rad) * half_m.x(), reach * std::sin(angle_rad) * half_m.y(), 0);
    for (const double end : {-1.0, 1.0}) corners.push_back(pose * (out + btVector3(0, 0, end * half_m.z())));
  }
}

}  // namespace

LinkShapes::LinkShapes(const Link& link, const btTransform& com_in_link) {
  const btTransform link_in_com = com_in_link.inverse();
  for (const Geometry& geometry : link.collisions) {
    parts_.push_back(std::visit(ConvexMaker{geometry}, geometry.shape));
    compound_.addChildShape(link_in_com * to_bullet(geometry.pose), parts_.back().get());
  }
}

double LinkShapes::lowest_m(const btTransform& pose) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < compound_.getNumChildShapes(); ++i) {
    const btTransform part = pose * compound_.getChildTransform(i);
    const btVector3 down = btVector3(0, 0, -1) * part.getBasis();
    const auto* convex = parts_[static_cast<std::size_t>(i)].get();
    const bool hull = convex->getShapeType() == CONVEX_HULL_SHAPE_PROXYTYPE;
    const btVector3 low =
        hull ? convex->localGetSupportingVertexWithoutMargin(down) : convex->localGetSupportingVertex(down);
    lowest = std::min<double>(lowest, (part * low).z());
  }
  return lowest;
}

std::vector<btVector3> LinkShapes::corners(const btTransform& pose) const {
  std::vector<btVector3> corners;
  for (int i = 0; i < compound_.getNumChildShapes(); ++i) {
    add_corners(*parts_[static_cast<std::size_t>(i)], pose * compound_.getChildTransform(i), corners);
  }
  return corners;
}

}  // namespace kadans::bullet
