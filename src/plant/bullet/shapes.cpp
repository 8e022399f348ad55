#include "shapes.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "convert.h"

namespace kadans::bullet {
namespace {

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
    throw std::invalid_argument("collision mesh '" + mesh.file + "' of link '" + geometry.link +
                                "': the Bullet plant takes boxes, spheres and cylinders");
  }
};

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
    lowest = std::min(lowest, (part * convex->localGetSupportingVertex(down)).z());
  }
  return lowest;
}

}  // namespace kadans::bullet
