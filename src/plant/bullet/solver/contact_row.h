// One point of contact in the solver: an impulse along the normal that only pushes, and friction across it within a
// cone.
//
// Each body in the contact that is a tree has y of the three directions, along its link's path (TreeFactor). A
// static or driven body has no y and enters with its velocity. A = sum of y y^T, 3 x 3, says how an impulse changes the
// contact's own velocity. The normal law is Bullet's: the velocity at the step's end is at least -distance / dt while
// apart, and erp * depth / dt, or what the restitution asks for, when overlapping.
// Soft ground is a spring and a damper instead, of the overlap and the velocity at the step's end: so it is stable
// however stiff it is.
//
// An iteration keeps all other impulses. It computes the normal impulse first, then the friction for this normal
// impulse. Friction first tries to hold: exactly, in both directions at once. If that takes more than friction *
// normal, the contact slides: friction takes a step against the sliding velocity, as long as the stiffest direction of
// A allows, and then goes back onto the cone. When the iterations have converged, the impulse lies on the cone,
// opposite to the sliding. Friction is no projection onto a fixed set: where it makes the normal impulse grow, a foot
// wedged in between for example, whole steps may go around in a circle for ever, and shorter ones arrive.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <LinearMath/btScalar.h>

#include "tree.h"

namespace kadans::bullet {

// Memory for the numbers of one step's rows. It is handed out in order and given back all at once. It grows when a step
// needs more than any step before; memory that was handed out stays where it is.
class RowMemory {
 public:
  btScalar* take(std::size_t count) {
    if (blocks_.empty() || used_ + count > block_size) next_block();
    btScalar* const taken = blocks_[block_].get() + used_;
    used_ += count + count % 2;  // aligned for two numbers at a time
    return taken;
  }
  void clear() { block_ = used_ = 0; }

 private:
  static constexpr std::size_t block_size = 16384;

  void next_block() {
    if (!blocks_.empty()) ++block_;
    if (block_ == blocks_.size()) blocks_.push_back(std::make_unique<btScalar[]>(block_size));
    used_ = 0;
  }

  std::vector<std::unique_ptr<btScalar[]>> blocks_;
  std::size_t block_ = 0, used_ = 0;
};

// How friction is limited: a circle, or for comparison Bullet's square along the two friction directions.
enum class FrictionLaw : std::uint8_t { cone, pyramid };

// One body of a contact.
struct ContactBody {
  Tree* tree = nullptr;  // or null
  int link = -1;
  btVector3 velocity_m_s{0, 0, 0};  // of a body that is no tree; driven bodies do not turn
};

struct ContactTiming {
  btScalar dt_s = 0, erp = 0, restitution_velocity_m_s = 0;
};

class ContactRow {
 public:
  // Starts from the point's impulses and keeps the point, to which finish() gives the new ones.
  ContactRow(btManifoldPoint& point, const ContactBody& first, const ContactBody& second, const ContactTiming& timing,
             RowMemory& memory);

  // Goes this share of the way. Returns how much the whole way changes a velocity.
  btScalar iterate(FrictionLaw law, btScalar share);
  void finish() const;

 private:
  using Three = std::array<btScalar, 4>;  // normal, two across; the last is 0
  struct Side {
    btScalar* z = nullptr;
    Path path;
    Three* y = nullptr;
  };

  void add_side(const ContactBody& body, const btVector3& at, btScalar sign, RowMemory& memory);
  void add_own_response(const Side& side);
  void add_shared_response();
  void aim(const ContactTiming& timing);
  void prepare_gains();
  [[gnu::noinline]] Three velocity() const;  // inlined, its first number would be computed twice
  [[gnu::always_inline]] void apply(const Three& change);
  void hold_or_slide(const Three& velocity, btScalar limit, FrictionLaw law, Three& impulse) const;

  btManifoldPoint* point_;
  std::array<btVector3, 3> directions_;
  std::array<Side, 2> sides_;
  int side_count_ = 0;
  bool same_tree_ = false;
  Three impulse_{}, bias_{};         // bias: velocity without any impulse, less the wanted one
  std::array<Three, 3> response_{};  // A
  btScalar softness_ = 0;            // velocity per impulse with which a soft ground gives way
  btScalar normal_gain_ = 0, slide_gain_ = 0;
  btScalar hold_[3] = {0, 0, 0};  // inverse of A's lower block: first, mixed, second
};

}  // namespace kadans::bullet
