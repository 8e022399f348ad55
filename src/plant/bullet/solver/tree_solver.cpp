#include "tree_solver.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "plant/bullet/contact/rolling_rows.h"
#include "plant/bullet/joint/joint_rows.h"

namespace kadans::bullet {
namespace {

constexpr std::size_t contacts_per_link = 6;  // room from the start, so that hardly any step allocates
constexpr int iterations_factor = 20;         // of all iterations to those that each step has
constexpr btScalar residual_wanted_m_s = 1e-3;
// m/s or rad/s; single precision has no less
constexpr btScalar tolerance = sizeof(btScalar) == sizeof(double) ? 1e-7 : 5e-5F;
constexpr btScalar shorter_step = 0.7;  // after twice the iterations that each step has

// Null where it was not added.
Tree* tree_of(const btMultiBody* body) { return static_cast<Tree*>(body->getUserPointer()); }

Tree* added(Tree* tree) {
  if (tree == nullptr) throw std::logic_error("a body is added before its rows");
  return tree;
}

bool at_limit(const JointLaw& law, btScalar impulse) { return impulse <= law.lower || impulse >= law.upper; }

}  // namespace

void TreeSolver::add(btMultiBody& body) {
  trees_.push_back(std::make_unique<Tree>(body));
  body.setUserPointer(trees_.back().get());
  contacts_.reserve(contacts_.capacity() + contacts_per_link * static_cast<std::size_t>(body.getNumLinks() + 1));
}

void TreeSolver::add(JointRows& rows) {
  Tree* const tree = added(tree_of(&rows.body()));
  Coordinate along = rows.coordinate();
  along.joint = tree->shape().dof(along.joint);
  if (along.carrier >= 0) along.carrier = tree->shape().dof(along.carrier);
  joints_.push_back({&rows, tree, along});
  joint_rows_.reserve(3 * joints_.size() + 3 * rollings_.size());
}

void TreeSolver::add(RollingRows& rows) {
  rollings_.push_back({&rows, added(tree_of(&rows.body()))});
  joint_rows_.reserve(3 * joints_.size() + 3 * rollings_.size());
}

void TreeSolver::solveMultiBodyGroup(btCollisionObject**, int, btPersistentManifold** manifolds, int manifold_count,
                                     btTypedConstraint**, int, btMultiBodyConstraint**, int,
                                     const btContactSolverInfo& info, btIDebugDraw*, btDispatcher*) {
  const Group all{this, {manifolds, static_cast<std::size_t>(manifold_count)}, {}, &info};
  solve_together({&all, 1});
}

void TreeSolver::solve_together(std::span<const Group> groups) {
  solve(groups, false);
  const auto beyond_limit = [](const Group& group) { return group.solver->servo_beyond_limit(); };
  if (std::ranges::any_of(groups, beyond_limit)) solve(groups, true);
  for (const Group& group : groups) group.solver->finish();
}

void TreeSolver::solve(std::span<const Group> groups, bool servo_rows) {
  for (const Group& group : groups) group.solver->begin(group.info->m_timeStep, servo_rows);
  for (const Group& group : groups) {
    TreeSolver& solver = *group.solver;
    for (Joint& joint : solver.joints_) solver.add_joint_rows(joint);
    solver.add_rolling_rows();
    solver.add_contacts(group.manifolds, *group.info);
    solver.add_contacts(group.crossing, *group.info);
  }
  iterate(groups);
  for (const Group& group : groups) {
    for (const auto& tree : group.solver->trees_) tree->accelerate();
  }
}

void TreeSolver::iterate(std::span<const Group> groups) {
  int each_step = 0;
  for (const Group& group : groups) each_step = std::max(each_step, group.info->m_numIterations);
  btScalar largest = 0;
  for (int i = 0; i < each_step || (i < iterations_factor * each_step && largest > residual_wanted_m_s); ++i) {
    largest = 0;
    const btScalar share = i < 2 * each_step ? 1 : shorter_step;
    for (const Group& group : groups) largest = std::max(largest, group.solver->iterate(share));
    if (largest <= tolerance) break;
  }
  for (const Group& group : groups) group.solver->residual_ = largest;
}

void TreeSolver::begin(btScalar dt_s, bool servo_rows) {
  memory_.clear();
  joint_rows_.clear();
  contacts_.clear();
  for (const auto& tree : trees_) tree->begin_step(dt_s);
  for (Joint& joint : joints_) {
    joint.rows->begin_step(dt_s);
    add_linear_laws(joint, servo_rows);
  }
  for (const auto& tree : trees_) tree->factorise();
}

void TreeSolver::add_linear_laws(Joint& joint, bool servo_rows) {
  const JointRows& rows = *joint.rows;
  if (rows.active(JointRows::linear)) {
    const JointLaw& law = rows.law(JointRows::linear);
    joint.tree->add_implicit(joint.along, law.at_rest, law.slope);
  }
  const JointLaw& servo = rows.law(JointRows::servo);
  joint.servo_is_linear = rows.active(JointRows::servo) && !servo_rows && !rows.servo_at_limit();
  if (joint.servo_is_linear) joint.tree->add_implicit(joint.along, servo.at_rest, servo.slope);
}

void TreeSolver::add_joint_rows(Joint& joint) {
  joint.first_row = joint_rows_.size();
  for (const auto kind : {JointRows::servo, JointRows::friction, JointRows::limit}) {
    if (!joint.rows->active(kind) || (kind == JointRows::servo && joint.servo_is_linear)) continue;
    joint_rows_.emplace_back(*joint.tree, joint.along, joint.rows->law(kind), joint.rows->last_impulse(kind), memory_);
  }
}

void TreeSolver::add_rolling_rows() {
  for (const Rolling& rolling : rollings_) {
    for (int axis = 0; axis < 3; ++axis) {
      const btScalar limit = rolling.rows->limit_Nms(axis);
      if (!(limit > 0)) continue;
      joint_rows_.emplace_back(*rolling.tree, Coordinate{.joint = axis},
                               JointLaw{.lower = -limit, .upper = limit, .stiff = true}, 0.0, memory_);
    }
  }
}

ContactBody TreeSolver::contact_body(const btCollisionObject& collider) {
  if (const auto* link = btMultiBodyLinkCollider::upcast(&collider); link != nullptr) {
    return {.tree = tree_of(link->m_multiBody), .link = link->m_link};
  }
  const btRigidBody* driven = btRigidBody::upcast(&collider);
  return {.velocity_m_s = driven == nullptr ? btVector3(0, 0, 0) : driven->getLinearVelocity()};
}

void TreeSolver::add_contacts(std::span<btPersistentManifold* const> manifolds, const btContactSolverInfo& info) {
  const ContactTiming timing{info.m_timeStep, info.m_erp2, info.m_restitutionVelocityThreshold};
  for (btPersistentManifold* const manifold : manifolds) {
    if (manifold->getNumContacts() == 0) continue;
    const ContactBody first = contact_body(*manifold->getBody0()), second = contact_body(*manifold->getBody1());
    for (int j = 0; j < manifold->getNumContacts(); ++j) {
      contacts_.emplace_back(manifold->getContactPoint(j), first, second, timing, memory_);
    }
  }
}

btScalar TreeSolver::iterate(btScalar share) {
  btScalar largest = 0;
  for (JointRow& row : joint_rows_) largest = std::max(largest, row.iterate());
  for (ContactRow& contact : contacts_) largest = std::max(largest, contact.iterate(friction_, share));
  return largest;
}

bool TreeSolver::servo_beyond_limit() const {
  return std::any_of(joints_.begin(), joints_.end(), [](const Joint& joint) {
    if (!joint.servo_is_linear) return false;
    const JointLaw& servo = joint.rows->law(JointRows::servo);
    const btScalar impulse = servo.at_rest - servo.slope * joint.tree->new_velocity(joint.along);
    return impulse < servo.lower || impulse > servo.upper;
  });
}

void TreeSolver::finish() {
  for (Joint& joint : joints_) finish_joint(joint);
  for (const ContactRow& contact : contacts_) contact.finish();
  for (const auto& tree : trees_) tree->end_step();
}

void TreeSolver::finish_joint(Joint& joint) {
  JointRows& rows = *joint.rows;
  const btScalar velocity = joint.tree->new_velocity(joint.along);
  std::size_t row = joint.first_row;
  for (const auto kind : {JointRows::linear, JointRows::servo, JointRows::friction, JointRows::limit}) {
    const JointLaw& law = rows.law(kind);
    const bool linear = kind == JointRows::linear || (kind == JointRows::servo && joint.servo_is_linear);
    btScalar impulse = 0;
    if (rows.active(kind)) impulse = linear ? law.at_rest - law.slope * velocity : joint_rows_[row++].impulse();
    rows.set_impulse(kind, impulse);
  }
  const bool limited =
      rows.active(JointRows::servo) && at_limit(rows.law(JointRows::servo), rows.last_impulse(JointRows::servo));
  rows.set_servo_at_limit(limited);
}

JointRow::JointRow(Tree& tree, const Coordinate& along, const JointLaw& law, btScalar impulse, RowMemory& memory)
    : tree_(&tree),
      path_(tree.shape().path(along.joint)),
      beyond_(along.carrier < 0 ? Path{} : tree.shape().beyond(along.carrier, along.joint)),
      y_(memory.take(static_cast<std::size_t>(path_.length + beyond_.length))),
      lower_(law.lower),
      upper_(law.upper) {
  btScalar* const scratch =
      beyond_.length == 0 ? nullptr : memory.take(static_cast<std::size_t>(tree.shape().path(along.carrier).length));
  tree.response(along, y_, scratch);
  for (int p = 0; p < path_.length + beyond_.length; ++p) response_ += y_[p] * y_[p];
  if (!(response_ > 0)) return;
  gain_ = law.stiff ? 1 / response_ : law.slope / (1 + law.slope * response_);
  leak_ = law.stiff ? 0 : 1 / (1 + law.slope * response_);
  offset_ = (law.stiff ? law.wanted_rad_s * gain_ : law.at_rest * leak_) - gain_ * tree.velocity(along);
  apply(std::clamp(impulse, lower_, upper_));
}

void JointRow::apply(btScalar change) {
  impulse_ += change;
  btScalar* const z = tree_->z();
  for (int p = 0; p < path_.length; ++p) z[path_.dofs[p]] += y_[p] * change;
  for (int p = 0; p < beyond_.length; ++p) z[beyond_.dofs[p]] += y_[path_.length + p] * change;
}

btScalar JointRow::iterate() {
  const btScalar* const z = tree_->z();
  btScalar velocity = 0;
  for (int p = 0; p < path_.length; ++p) velocity += y_[p] * z[path_.dofs[p]];
  for (int p = 0; p < beyond_.length; ++p) velocity += y_[path_.length + p] * z[beyond_.dofs[p]];
  const btScalar wanted = impulse_ + offset_ - gain_ * velocity - leak_ * impulse_;
  const btScalar change = std::clamp(wanted, lower_, upper_) - impulse_;
  if (change != 0) apply(change);
  return std::abs(change) * response_;
}

}  // namespace kadans::bullet
