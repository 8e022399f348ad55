#include "ground_contact.h"

#include <algorithm>
#include <array>
#include <new>
#include <span>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "part_contact.h"

namespace kadans::bullet {
namespace {

constexpr std::size_t points_per_shape = 4;

struct Corner {
  btVector3 point;
  int number = 0;  // of the shape's corners, the same in every step
};

class LastImpulses {
 public:
  explicit LastImpulses(const btPersistentManifold& manifold) {
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      at_[static_cast<std::size_t>(i)] = {point.m_index0, LastImpulse(point)};
    }
  }
  // Of a corner that touched in the last step already, or none.
  LastImpulse of(int corner) const {
    for (const AtCorner& one : at_) {
      if (one.corner == corner) return one.impulse;
    }
    return {};
  }

 private:
  struct AtCorner {
    int corner = -1;
    LastImpulse impulse;
  };
  std::array<AtCorner, points_per_shape> at_;
};

// The lowest few of the points offered, in the ground's frame, lowest first; of equals the one offered first.
class LowestPoints {
 public:
  void offer(const btVector3& point, int number) {
    if (!(point.z() < contact_distance_m)) return;
    std::size_t at = count_;
    while (at > 0 && point.z() < points_[at - 1].point.z()) --at;
    if (at == points_per_shape) return;
    count_ = std::min(count_ + 1, points_per_shape);
    for (std::size_t i = count_ - 1; i > at; --i) points_[i] = points_[i - 1];
    points_[at] = {point, number};
  }
  const Corner* begin() const { return points_.data(); }
  const Corner* end() const { return points_.data() + count_; }

 private:
  std::array<Corner, points_per_shape> points_;
  std::size_t count_ = 0;
};

void offer_box(const btBoxShape& box, const btTransform& pose, LowestPoints& points) {
  const btVector3 half = box.getHalfExtentsWithMargin();
  for (int corner = 0; corner < 8; ++corner) {
    const btVector3 signs((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
    points.offer(pose * (half * signs), corner);
  }
}

// On each rim the lowest point, the one across, and the two between.
void offer_cylinder(const btCylinderShapeZ& cylinder, const btTransform& pose, LowestPoints& points) {
  const btVector3 half = cylinder.getHalfExtentsWithMargin();
  btVector3 down = btVector3(0, 0, -1) * pose.getBasis();
  down.setZ(0);
  down = down.length2() > 1e-12 ? down.normalized() : btVector3(1, 0, 0);
  const btVector3 side(-down.y(), down.x(), 0);
  int number = 0;
  for (const btVector3& out : {down, side, -side, -down}) {
    for (const double end : {-1.0, 1.0}) {
      points.offer(pose * (half.x() * out + btVector3(0, 0, end * half.z())), number++);
    }
  }
}

// Of the corners near the ground those that carry it, as of a face of a box.
void offer_hull(const btConvexHullShape& hull, const btTransform& pose, LowestPoints& points) {
  std::array<btVector3, hull_corners_max> near;
  std::array<int, hull_corners_max> numbers{};
  std::size_t count = 0;
  for (int corner = 0; corner < hull.getNumPoints(); ++corner) {
    const btVector3 point = pose * hull.getUnscaledPoints()[corner];
    if (!(point.z() < contact_distance_m) || count == near.size()) continue;
    near[count] = point;
    numbers[count++] = corner;
  }
  for (const std::size_t i : carrying(std::span(near).first(count), 2, 1)) points.offer(near[i], numbers[i]);
}

LowestPoints lowest_points(const btCollisionShape& shape, const btTransform& pose) {
  LowestPoints points;
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      points.offer(pose.getOrigin() - btVector3(0, 0, static_cast<const btSphereShape&>(shape).getRadius()), 0);
      break;
    case BOX_SHAPE_PROXYTYPE:
      offer_box(static_cast<const btBoxShape&>(shape), pose, points);
      break;
    case CYLINDER_SHAPE_PROXYTYPE:
      offer_cylinder(static_cast<const btCylinderShapeZ&>(shape), pose, points);
      break;
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      offer_hull(static_cast<const btConvexHullShape&>(shape), pose, points);
      break;
    default:
      break;  // shapes.h makes no others
  }
  return points;
}

// No point of the shape is further from its origin.
double reach_m(const btCollisionShape& shape) {
  btVector3 center;
  btScalar radius = 0;
  shape.getBoundingSphere(center, radius);
  return center.length() + radius;
}

class GroundContact final : public PartContact {
 public:
  GroundContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObject& link,
                const btCollisionObject& ground)
      : PartContact(info, link, ground), link_(&link), ground_(&ground), surface_(link, ground) {
    reaches_m_.reserve(manifolds_.size());
    for (int i = 0; i < manifolds_.size(); ++i) reaches_m_.push_back(reach_m(*parts_of(link).getChildShape(i)));
  }

  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*, const btDispatcherInfo&,
                        btManifoldResult*) override {
    const btCompoundShape& parts = parts_of(*link_);
    const btVector3 up = ground_->getWorldTransform().getBasis().getColumn(2);
    for (int i = 0; i < manifolds_.size(); ++i) {
      const LastImpulses last(*manifolds_[i]);
      manifolds_[i]->clearManifold();
      const btVector3 center = link_->getWorldTransform() * parts.getChildTransform(i).getOrigin();
      if (up.dot(center - ground_->getWorldTransform().getOrigin()) > reaches_m_[i] + contact_distance_m) continue;
      const btTransform part =
          ground_->getWorldTransform().inverseTimes(link_->getWorldTransform()) * parts.getChildTransform(i);
      for (const Corner& corner : lowest_points(*parts.getChildShape(i), part)) {
        add(*manifolds_[i], corner, last.of(corner.number));
      }
    }
  }

 private:
  void add(btPersistentManifold& manifold, const Corner& corner, const LastImpulse& last) const {
    const double distance_m = corner.point.z();
    if (!surface_.counts(distance_m)) return;
    const btTransform& ground = ground_->getWorldTransform();
    const btVector3 point = ground * corner.point;
    const btVector3 on_ground(corner.point.x(), corner.point.y(), 0);
    btManifoldPoint contact(link_->getWorldTransform().invXform(point), on_ground, ground.getBasis().getColumn(2),
                            distance_m);
    contact.m_positionWorldOnA = point;
    contact.m_positionWorldOnB = ground * on_ground;
    surface_.give(contact);
    contact.m_index0 = corner.number;
    last.give(contact);
    manifold.addManifoldPoint(contact);
  }

  const btCollisionObject* link_;
  const btCollisionObject* ground_;
  ContactSurface surface_;
  btAlignedObjectArray<btScalar> reaches_m_;  // one a part
};

}  // namespace

void GroundContactMaker::register_with(btCollisionDispatcher& dispatcher) {
  dispatcher.registerCollisionCreateFunc(COMPOUND_SHAPE_PROXYTYPE, STATIC_PLANE_PROXYTYPE, this);
  dispatcher.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, COMPOUND_SHAPE_PROXYTYPE, this);
}

btCollisionAlgorithm* GroundContactMaker::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                   const btCollisionObjectWrapper* a,
                                                                   const btCollisionObjectWrapper* b) {
  const bool link_first = a->getCollisionShape()->isCompound();
  const btCollisionObject& link = *(link_first ? a : b)->getCollisionObject();
  const btCollisionObject& ground = *(link_first ? b : a)->getCollisionObject();
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(GroundContact));
  return new (memory) GroundContact(info, link, ground);
}

}  // namespace kadans::bullet
