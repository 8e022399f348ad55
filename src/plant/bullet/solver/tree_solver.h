// The plant's own solver of contacts and joint laws, in place of Bullet's iteration over full joint-space vectors.
//
// Bullet's multibody solver runs one articulated-body pass for each row of each contact to learn what the row moves,
// and iterates over vectors of all joint velocities. Here each multibody's joint-space inertia is made and factorised
// once a step (tree.h), a row's response is a dozen numbers along its path to the base (TreeFactor), and joint laws
// that are linear never become rows: they add to the inertia's diagonal.
//
// A servo (position or velocity mode, limited to the drive's torque) is linear while it stays within its limits. It is
// treated as linear unless it was at its limit in the last step. If a servo then turns out to be beyond its limits, the
// step is solved again with every servo as a row.
//
// Projected Gauss-Seidel: rows of joints first, then contacts in the order of Bullet's manifolds, starting from the
// last step's impulses, until an iteration changes no velocity by more than 1e-7 m/s or rad/s (5e-5 in single
// precision) or the iterations are used up. Where they leave more than 0.001 m/s open (an impact, a load that is heavy
// beside the links under it, a light foot between the ground and its joint's limit) it goes on until they do not, up to
// iterations_factor times as many; soon with shorter steps, since what has not arrived by then goes around in a circle
// (contact_row.h).
//
// It covers what the plant's worlds consist of, and nothing else: any number of multibodies with joints of one degree
// of freedom, in contact with each other, themselves and static or driven bodies.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include "contact_row.h"
#include "joint_law.h"
#include "tree.h"

namespace kadans::bullet {

// A law of one joint or coupled drive that is not linear, or one of a free body's axes: a row of one number in the
// solver's iteration.
//
// The law is that of joint_rows.h: p = clamp(a - b v, lower, upper), or v = wanted within the limits of p when it is
// stiff. With y of the degree of freedom (TreeFactor) and d = y . y, an iteration sets p so that the law is
// fulfilled while all other impulses stay: p += (a - b v - p) / (1 + b d), or p += (wanted - v) / d, clamped.
class JointRow {
 public:
  // Starts from `impulse`. The memory lives as long as the row.
  JointRow(Tree& tree, const Coordinate& along, const JointLaw& law, btScalar impulse, RowMemory& memory);

  // Returns how much it changed its velocity.
  btScalar iterate();
  btScalar impulse() const { return impulse_; }

 private:
  void apply(btScalar change);

  Tree* tree_;
  Path path_, beyond_;  // of the joint, and what the other joint of the coordinate has beyond it
  btScalar* y_;         // along both
  btScalar lower_, upper_;
  btScalar offset_ = 0, gain_ = 0, leak_ = 0, response_ = 0;  // p += offset - gain v - leak p
  btScalar impulse_ = 0;
};

class JointRows;
class RollingRows;

class TreeSolver final : public btMultiBodyConstraintSolver {
 public:
  explicit TreeSolver(FrictionLaw friction) : friction_(friction) {}

  // Everything in the world must be added before the first step, a body before its rows.
  void add(btMultiBody& body);
  void add(JointRows& rows);
  void add(RollingRows& rows);
  // How much the last iteration of the last step changed a velocity, m/s or rad/s.
  btScalar residual() const { return residual_; }
  void reserve_contacts(std::size_t manifolds) { contacts_.reserve(contacts_.capacity() + 4 * manifolds); }

  // The contacts of one solver's bodies: with each other and what stands still, and with bodies of other solvers.
  struct Group {
    TreeSolver* solver;
    std::span<btPersistentManifold*const> manifolds, crossing;
    const btContactSolverInfo* info;
  };
  // The groups must contain all bodies that their contacts name.
  static void solve_together(std::span<const Group> groups);

  // Contacts, joint laws and free motion at once; the new velocities are in the bodies afterwards.
  void solveMultiBodyGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                           int manifold_count, btTypedConstraint** constraints, int constraint_count,
                           btMultiBodyConstraint** rows, int row_count, const btContactSolverInfo& info,
                           btIDebugDraw* draw, btDispatcher* dispatcher) override;

 private:
  struct Joint {
    JointRows* rows;
    Tree* tree;
    Coordinate along;             // of degrees of freedom
    std::size_t first_row = 0;    // of this step, in joint_rows_; in the order of the kinds
    bool servo_is_linear = true;  // in this step
  };
  struct Rolling {
    RollingRows* rows;
    Tree* tree;
  };

  ContactBody contact_body(const btCollisionObject& collider);
  static void solve(std::span<const Group> groups, bool servo_rows);
  void begin(btScalar dt_s, bool servo_rows);
  void add_linear_laws(Joint& joint, bool servo_rows);
  void add_joint_rows(Joint& joint);
  void add_rolling_rows();
  void add_contacts(std::span<btPersistentManifold* const> manifolds, const btContactSolverInfo& info);
  static void iterate(std::span<const Group> groups);
  btScalar iterate(btScalar share);  // returns the largest change of a velocity
  bool servo_beyond_limit() const;
  void finish();
  void finish_joint(Joint& joint);

  FrictionLaw friction_;
  btScalar residual_ = 0;
  std::vector<std::unique_ptr<Tree>> trees_;
  std::vector<Joint> joints_;
  std::vector<Rolling> rollings_;
  RowMemory memory_;
  std::vector<JointRow> joint_rows_;
  std::vector<ContactRow> contacts_;
};

}  // namespace kadans::bullet
