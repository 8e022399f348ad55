// Which links may collide with which. Parent and child never do, nor do pairs that touch when all joints are at 0
// (links around one point, such as a hip's). Bullet's own parent flag is unreliable: this table alone decides.
// The table is for the links of the robot; different bodies may always collide.
#pragma once

#include <vector>

#include <btBulletCollisionCommon.h>

namespace kadans::bullet {

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

}  // namespace kadans::bullet
