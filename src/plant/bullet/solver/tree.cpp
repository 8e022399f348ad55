#include "tree.h"

#include <algorithm>
#include <cmath>

namespace kadans::bullet {
Tree::Tree(btMultiBody& body)
    : body_(&body),
      shape_(body),
      factor_(shape_),
      fixed_(body.hasFixedBase()),
      links_(static_cast<std::size_t>(shape_.link_count()) + 1),
      axes_(static_cast<std::size_t>(shape_.dof_count())),
      z_(static_cast<std::size_t>(shape_.dof_count())) {}

void Tree::begin_step(btScalar dt_s) {
  begin_base();
  for (int link = 0; link < shape_.link_count(); ++link) begin_link(link);
  gather();
  fill_base_rows();
  for (int link = 0; link < shape_.link_count(); ++link) {
    const int dof = shape_.dof(link);
    if (dof < 0) continue;
    fill_joint_row(link);
    z_[static_cast<std::size_t>(dof)] = dt_s * (body_->getJointTorque(link) - dot(state(link).axis, state(link).force));
  }
  const Wrench& base = state(-1).force;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    z_[k] = fixed_ ? 0 : -dt_s * base.moment[i];
    z_[k + 3] = fixed_ ? 0 : -dt_s * base.force[i];
  }
}

// The base's coordinates are the velocity of a point that moves with it: that velocity staying the same, what is at
// the origin accelerates by the second term.
void Tree::begin_base() {
  LinkState& base = state(-1);
  const btTransform pose = body_->getBaseWorldTransform();
  origin_m_ = pose.getOrigin();
  base.velocity = {body_->getBaseOmega(), body_->getBaseVel()};
  base.acceleration = {btVector3(0, 0, 0), -base.velocity.angular.cross(base.velocity.linear)};
  set_inertia(base, pose, body_->getBaseMass(), body_->getBaseInertia(), body_->getBaseForce(), body_->getBaseTorque());
}

void Tree::begin_link(int number) {
  const btMultibodyLink& from = body_->getLink(number);
  const LinkState& parent = state(shape_.parent(number));
  LinkState& link = state(number);
  link.velocity = parent.velocity;
  link.acceleration = parent.acceleration;
  const btTransform& pose = from.m_cachedWorldTransform;
  if (const int dof = shape_.dof(number); dof >= 0) {
    const btVector3 angular = pose.getBasis() * from.m_axes[0].m_topVec;
    const btVector3 at_com = pose.getBasis() * from.m_axes[0].m_bottomVec;
    link.axis = {angular, at_com + (pose.getOrigin() - origin_m_).cross(angular)};
    axes_[static_cast<std::size_t>(dof)] = link.axis;
    const Motion turn = link.axis * velocity(dof);
    link.velocity = link.velocity + turn;
    link.acceleration = link.acceleration + carried(link.velocity, turn);
  }
  set_inertia(link, pose, from.m_mass, from.m_inertiaLocal, from.m_appliedForce, from.m_appliedTorque);
}

void Tree::set_inertia(LinkState& link, const btTransform& pose, btScalar mass_kg, const btVector3& moments_kg_m2,
                       const btVector3& force_N, const btVector3& torque_Nm) const {
  const btVector3 com_m = pose.getOrigin() - origin_m_;
  link.inertia = spatial_inertia(mass_kg, moments_kg_m2, pose.getBasis(), com_m);
  const Wrench applied{torque_Nm + com_m.cross(force_N), force_N};
  link.force = link.inertia * link.acceleration + carried(link.velocity, link.inertia * link.velocity) - applied;
}

// From the leaves on, each link carries what hangs on it.
void Tree::gather() {
  for (int link = shape_.link_count() - 1; link >= 0; --link) {
    LinkState& parent = state(shape_.parent(link));
    parent.inertia += state(link).inertia;
    parent.force = parent.force + state(link).force;
  }
}

void Tree::fill_joint_row(int link) {
  const int dof = shape_.dof(link);
  const Path path = shape_.path(dof);
  btScalar* const row = factor_.row(dof);
  const Wrench force = state(link).inertia * state(link).axis;  // that turns the joint alone by 1 rad/s in 1 s
  for (int i = 0; i < 3; ++i) {
    row[i] = fixed_ ? 0 : force.moment[i];
    row[i + 3] = fixed_ ? 0 : force.force[i];
  }
  for (int p = base_dofs; p < path.length; ++p) row[p] = dot(axes_[static_cast<std::size_t>(path.dofs[p])], force);
}

void Tree::fill_base_rows() {
  const SpatialInertia& all = state(-1).inertia;
  const btVector3& c = all.moment_kg_m;
  const btScalar angular[3][3] = {{all.xx, 0, 0}, {all.xy, all.yy, 0}, {all.xz, all.yz, all.zz}};
  const btScalar mixed[3][3] = {{0, c.z(), -c.y()}, {-c.z(), 0, c.x()}, {c.y(), -c.x(), 0}};
  for (int i = 0; i < 3; ++i) {
    btScalar* const turn = factor_.row(i);
    btScalar* const shift = factor_.row(i + 3);
    for (int j = 0; j <= i; ++j) turn[j] = fixed_ ? 0 : angular[i][j];
    for (int j = 0; j < 3 + i; ++j) shift[j] = fixed_ || j >= 3 ? 0 : mixed[i][j];
    if (fixed_) turn[i] = 1;
    shift[i + 3] = fixed_ ? 1 : all.mass_kg;
  }
}

void Tree::add_implicit(const Coordinate& along, btScalar at_rest, btScalar slope) {
  const int last = shape_.path(along.joint).length - 1;
  const btScalar impulse = at_rest - slope * velocity(along);
  btScalar* const row = factor_.row(along.joint);
  row[last] += slope * along.share * along.share;
  z_[static_cast<std::size_t>(along.joint)] += along.share * impulse;
  if (along.carrier < 0) return;
  const int carrier = shape_.path(along.carrier).length - 1;  // there it stands on the joint's path, too
  row[carrier] += slope * along.share * along.carrier_share;
  factor_.row(along.carrier)[carrier] += slope * along.carrier_share * along.carrier_share;
  z_[static_cast<std::size_t>(along.carrier)] += along.carrier_share * impulse;
}

void Tree::factorise() {
  factor_.factorise();
  factor_.first_half(z());
}

void Tree::accelerate() {
  if (fixed_) std::fill_n(z_.begin(), base_dofs, 0.0);  // whatever came of a state that is not finite
  factor_.second_half(z());
}

// What is infinite becomes not a number: Bullet would cut it down to its greatest velocity, and hide it.
void Tree::end_step() {
  for (btScalar& change : z_) change += 0 * change;
  body_->applyDeltaVeeMultiDof(z(), 1);
}

void Tree::response(int link, const std::array<Wrench, 3>& wrenches, std::array<btScalar, 4>* y) const {
  const Path path = shape_.link_path(link);
  for (std::size_t c = 0; c < 3; ++c) {
    for (int i = 0; i < 3; ++i) {
      y[i][c] = fixed_ ? 0 : wrenches[c].moment[i];
      y[i + 3][c] = fixed_ ? 0 : wrenches[c].force[i];
    }
  }
  for (int p = 0; p < path.length; ++p) {
    y[p][3] = 0;
    if (p < base_dofs) continue;
    const Motion& axis = axes_[static_cast<std::size_t>(path.dofs[p])];
    for (std::size_t c = 0; c < 3; ++c) y[p][c] = dot(axis, wrenches[c]);
  }
  factor_.first_half(path.dofs[path.length - 1], y);
}

void Tree::response(const Coordinate& along, btScalar* y, btScalar* scratch) const {
  const int last = shape_.path(along.joint).length - 1;
  const Path beyond = along.carrier < 0 ? Path{} : shape_.beyond(along.carrier, along.joint);
  for (int p = 0; p < last; ++p) y[p] = 0;
  y[last] = along.share;
  if (along.carrier >= 0 && beyond.length == 0) y[shape_.path(along.carrier).length - 1] = along.carrier_share;
  factor_.first_half(along.joint, y);
  if (beyond.length == 0) return;
  const int length = shape_.path(along.carrier).length, common = length - beyond.length;
  std::fill_n(scratch, length - 1, 0.0);
  scratch[length - 1] = along.carrier_share;
  factor_.first_half(along.carrier, scratch);
  for (int p = 0; p < common; ++p) y[p] += scratch[p];
  std::copy_n(scratch + common, beyond.length, y + last + 1);
}

TreeFactor::TreeFactor(const TreeShape& shape)
    : shape_(&shape),
      entries_(static_cast<std::size_t>(shape.entry_count())),
      scales_(static_cast<std::size_t>(shape.dof_count())) {}

void TreeFactor::factorise() {
  for (int k = shape_->dof_count() - 1; k >= 0; --k) {
    const Path path = shape_->path(k);
    btScalar* const own = row(k);
    const btScalar diagonal = own[path.length - 1], inverse = 1 / diagonal;
    scales_[static_cast<std::size_t>(k)] = 1 / std::sqrt(diagonal);
    for (int p = path.length - 2; p >= 0; --p) {
      const btScalar share = own[p] * inverse;
      btScalar* const carrier = row(path.dofs[p]);
      for (int q = 0; q <= p; ++q) carrier[q] -= share * own[q];
      own[p] = share;
    }
  }
}

void TreeFactor::first_half(int dof, btScalar* y) const {
  const Path path = shape_->path(dof);
  for (int p = path.length - 1; p >= 0; --p) {
    const btScalar* const factor = row(path.dofs[p]);
    const btScalar value = y[p];
    for (int q = 0; q < p; ++q) y[q] -= value * factor[q];
    y[p] = value * scale(path.dofs[p]);
  }
}

void TreeFactor::first_half(int dof, std::array<btScalar, 4>* y) const {
  const Path path = shape_->path(dof);
  for (int p = path.length - 1; p >= 0; --p) {
    const btScalar* const factor = row(path.dofs[p]);
    const std::array<btScalar, 4> value = y[p];
#pragma GCC unroll 2
    for (int q = 0; q < p; ++q) {
      const btScalar share = factor[q];
      for (std::size_t c = 0; c < 4; ++c) y[q][c] -= value[c] * share;
    }
    const btScalar own = scale(path.dofs[p]);
    for (std::size_t c = 0; c < 4; ++c) y[p][c] = value[c] * own;
  }
}

void TreeFactor::first_half(btScalar* y) const {
  for (int k = shape_->dof_count() - 1; k >= 0; --k) {
    const Path path = shape_->path(k);
    const btScalar* const factor = row(k);
    const btScalar value = y[k];
    for (int p = 0; p < path.length - 1; ++p) y[path.dofs[p]] -= value * factor[p];
    y[k] = value * scale(k);
  }
}

void TreeFactor::second_half(btScalar* x) const {
  for (int k = 0; k < shape_->dof_count(); ++k) {
    const Path path = shape_->path(k);
    const btScalar* const factor = row(k);
    btScalar value = x[k] * scale(k);
    for (int p = 0; p < path.length - 1; ++p) value -= factor[p] * x[path.dofs[p]];
    x[k] = value;
  }
}

TreeShape::TreeShape(const btMultiBody& body) {
  for (int dof = 0; dof < base_dofs; ++dof) add_row(dof - 1);
  links_.emplace_back();
  for (int i = 0; i < body.getNumLinks(); ++i) {
    const Link parent = at(body.getParent(i));
    Link link{body.getParent(i), -1, parent.last_dof};
    if (body.getLink(i).m_dofCount == 1) {
      link.dof = link.last_dof = dof_count();
      add_row(parent.last_dof);
    }
    links_.push_back(link);
  }
}

Path TreeShape::beyond(int dof, int other) const {
  const Path own = path(dof), others = path(other);
  int common = 0;
  while (common < std::min(own.length, others.length) && own.dofs[common] == others.dofs[common]) ++common;
  return {own.dofs + common, own.length - common};
}

void TreeShape::add_row(int parent_dof) {
  const int start = entry_count(), length = parent_dof < 0 ? 0 : path(parent_dof).length;
  for (int i = 0; i < length; ++i) {
    dofs_.push_back(dofs_[static_cast<std::size_t>(row_start(parent_dof) + i)]);
  }
  dofs_.push_back(dof_count());
  rows_.push_back({start, length + 1});
}

}  // namespace kadans::bullet
