// One multibody in the solver: its motion, its joint-space inertia and the impulses of a step, all in world axes about
// the base's centre of mass.
//
// With the velocities u (base and joints), a step of dt solves
//     M (u_new - u) = dt (tau - h) + a - B u_new + J^T p.
// M is the joint-space inertia by the composite rigid body method (RBDA table 6.2). tau are the joints' torques. h are
// the forces of gravity, pushes, centrifugal and Coriolis terms, by a recursive Newton-Euler pass with zero
// acceleration (RBDA table 5.1). a - B u_new are the implicit laws of the joints (damping, rotor inertia, springs,
// drives; joint_rows.h): B is diagonal, but where a drive moves two joints, and is simply added to M. J^T p are the
// impulses of contacts and other rows. With M + B = L^T D L and G from tree_factor.h, the unknown is z = G (M + B)
// (u_new - u): it begins as G (dt (tau - h)
// + a - B u), each row adds y p, and u_new = u + G^T z.
//
// Calls in a step: begin_step, add_implicit for each joint with implicit laws, factorise, rows, accelerate, end_step.
#pragma once

#include <array>
#include <vector>

#include "joint_law.h"
#include "spatial.h"
#include "tree_factor.h"

namespace kadans::bullet {

class Tree {
 public:
  explicit Tree(btMultiBody& body);
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;

  btMultiBody& body() { return *body_; }
  const TreeShape& shape() const { return shape_; }

  void begin_step(btScalar dt_s);
  // An impulse at_rest - slope * velocity_new along a coordinate of degrees of freedom.
  void add_implicit(const Coordinate& along, btScalar at_rest, btScalar slope);
  void factorise();
  void accelerate();  // after the last row; from here on new_velocity() is known
  btScalar new_velocity(const Coordinate& along) const {
    const auto one = [&](int dof) { return velocity(dof) + z_[static_cast<std::size_t>(dof)]; };
    return along.carrier < 0 ? one(along.joint)
                             : along.share * one(along.joint) + along.carrier_share * one(along.carrier);
  }
  void end_step();  // gives the new velocities to the body

  // How fast a point of the link on this wrench's line moves along the line, at the beginning of the step.
  btScalar velocity_along(int link, const Wrench& wrench) const { return dot(state(link).velocity, wrench); }
  btScalar velocity(int dof) const { return body_->getVelocityVector()[dof]; }
  btScalar velocity(const Coordinate& along) const {
    return along.carrier < 0 ? velocity(along.joint)
                             : along.share * velocity(along.joint) + along.carrier_share * velocity(along.carrier);
  }
  // y = G J^T along the link's path, J of three wrenches on the link; a fourth column is 0.
  void response(int link, const std::array<Wrench, 3>& wrenches, std::array<btScalar, 4>* y) const;
  // The same for an impulse along a coordinate, on the path of its joint.
  void response(const Coordinate& along, btScalar* y) const;

  btScalar* z() { return z_.data(); }
  const btVector3& origin_m() const { return origin_m_; }

 private:
  struct LinkState {
    Motion axis;  // of the link's joint
    Motion velocity, acceleration;
    Wrench force;            // that moves it without accelerating any joint; later with all that it carries
    SpatialInertia inertia;  // of the link; later with all that it carries
  };

  LinkState& state(int link) { return links_[static_cast<std::size_t>(link + 1)]; }
  const LinkState& state(int link) const { return links_[static_cast<std::size_t>(link + 1)]; }
  void begin_base();
  void begin_link(int link);
  void set_inertia(LinkState& link, const btTransform& pose, btScalar mass_kg, const btVector3& moments_kg_m2,
                   const btVector3& force_N, const btVector3& torque_Nm) const;
  void gather();
  void fill_joint_row(int link);
  void fill_base_rows();

  btMultiBody* body_;
  TreeShape shape_;
  TreeFactor factor_;
  bool fixed_;
  btVector3 origin_m_{0, 0, 0};
  std::vector<LinkState> links_;  // the base first
  std::vector<Motion> axes_;      // of the degrees of freedom after the base's
  std::vector<btScalar> z_;
};

}  // namespace kadans::bullet
