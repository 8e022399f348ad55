// A link's collision geometry as Bullet shapes: every shape convex, gathered in one compound about the link's centre of
// mass frame. The link's shapes live as long as this object.
#pragma once

#include <memory>
#include <vector>

#include <btBulletCollisionCommon.h>

#include "kadans/model/robot_model.h"

namespace kadans::bullet {

// Which links may collide with which. Parent and child never do, nor do pairs that touch when all joints are at 0
// (links around one point, such as a hip's). Bullet's own parent flag is unreliable: this table alone decides.
// The table is for the links of the robot; different bodies may always collide.
class PairMask final : public btOverlapFilterCallback {
 public:
  explicit PairMask(std::size_t links) : links_(links), forbidden_(links * links, false) {}

  void forbid(std::size_t a, std::size_t b) { forbidden_[a * links_ + b] = forbidden_[b * links_ + a] = true; }
  void forbid_all() { forbidden_.assign(forbidden_.size(), true); }
  bool allowed(std::size_t a, std::size_t b) const { return !forbidden_[a * links_ + b]; }

  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;

 private:
  std::size_t links_;
  std::vector<bool> forbidden_;
};

class LinkShapes {
 public:
  // `com_in_link` is the centre of mass frame that Bullet moves. Throws std::invalid_argument, naming it, on a
  // mesh that nobody has read or with more than hull_corners_max corners.
  LinkShapes(const Link& link, const btTransform& com_in_link);

  bool empty() const { return parts_.empty(); }
  btCollisionShape* shape() { return &compound_; }
  // The height of the lowest point when the centre of mass frame is at `pose`.
  double lowest_m(const btTransform& pose) const;
  // The points that would stand on a surface: corners, points of the rims, undersides of spheres.
  std::vector<btVector3> corners(const btTransform& pose) const;

 private:
  std::vector<std::unique_ptr<btConvexShape>> parts_;
  btCompoundShape compound_{false};  // a handful of children: a tree costs more than it saves
};

}  // namespace kadans::bullet
