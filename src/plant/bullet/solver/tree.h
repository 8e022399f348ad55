// One multibody in the solver: its motion, its joint-space inertia and the impulses of a step, all in world axes about
// the base's centre of mass.
//
// With the velocities u (base and joints), a step of dt solves
//     M (u_new - u) = dt (tau - h) + a - B u_new + J^T p.
// M is the joint-space inertia by the composite rigid body method (RBDA table 6.2). tau are the joints' torques. h are
// the forces of gravity, pushes, centrifugal and Coriolis terms, by a recursive Newton-Euler pass with zero
// acceleration (RBDA table 5.1). a - B u_new are the implicit laws of the joints (damping, rotor inertia, springs,
// drives; joint_rows.h): B is diagonal, but where a drive moves two joints, and is simply added to M. J^T p are the
// impulses of contacts and other rows. With M + B = L^T D L and G from TreeFactor, the unknown is z = G (M + B)
// (u_new - u): it begins as G (dt (tau - h)
// + a - B u), each row adds y p, and u_new = u + G^T z.
//
// Calls in a step: begin_step, add_implicit for each joint with implicit laws, factorise, rows, accelerate, end_step.
#pragma once

#include <array>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <LinearMath/btTransform.h>

#include "joint_law.h"

namespace kadans::bullet {

// Spatial vectors and rigid-body inertia in world axes about one common origin, so that no change of frame is needed.
// Featherstone, Rigid Body Dynamics Algorithms (RBDA), chapter 2. Units: rad, m, s, kg, N.
struct Motion {  // velocity or acceleration of the body's point at the origin
  btVector3 angular{0, 0, 0}, linear{0, 0, 0};
};

struct Wrench {  // moment about the origin, and force
  btVector3 moment{0, 0, 0}, force{0, 0, 0};
};

inline Motion operator+(const Motion& a, const Motion& b) { return {a.angular + b.angular, a.linear + b.linear}; }
inline Motion operator*(const Motion& m, btScalar s) { return {m.angular * s, m.linear * s}; }
inline Wrench operator+(const Wrench& a, const Wrench& b) { return {a.moment + b.moment, a.force + b.force}; }
inline Wrench operator-(const Wrench& a, const Wrench& b) { return {a.moment - b.moment, a.force - b.force}; }
inline btScalar dot(const Motion& m, const Wrench& w) { return m.angular.dot(w.moment) + m.linear.dot(w.force); }

inline Wrench wrench_at(const btVector3& point_m, const btVector3& force) { return {point_m.cross(force), force}; }

// The rate of change of a motion vector that moves with a body of velocity v (RBDA 2.31), and of a wrench (RBDA 2.32).
inline Motion carried(const Motion& v, const Motion& m) {
  return {v.angular.cross(m.angular), v.angular.cross(m.linear) + v.linear.cross(m.angular)};
}
inline Wrench carried(const Motion& v, const Wrench& w) {
  return {v.angular.cross(w.moment) + v.linear.cross(w.force), v.angular.cross(w.force)};
}

// Mass, first moment m c, and the six different entries of the rotational inertia about the origin (RBDA 2.63).
struct SpatialInertia {
  btScalar mass_kg = 0;
  btVector3 moment_kg_m{0, 0, 0};
  btScalar xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  SpatialInertia& operator+=(const SpatialInertia& other) {
    mass_kg += other.mass_kg;
    moment_kg_m += other.moment_kg_m;
    xx += other.xx, yy += other.yy, zz += other.zz;
    xy += other.xy, xz += other.xz, yz += other.yz;
    return *this;
  }

  btVector3 turned(const btVector3& w) const {
    return {xx * w.x() + xy * w.y() + xz * w.z(), xy * w.x() + yy * w.y() + yz * w.z(),
            xz * w.x() + yz * w.y() + zz * w.z()};
  }

  Wrench operator*(const Motion& m) const {
    return {turned(m.angular) + moment_kg_m.cross(m.linear), mass_kg * m.linear - moment_kg_m.cross(m.angular)};
  }
};

// Of a body with these principal moments about its centre of mass, which is at `com_m` and turned by `axes`.
inline SpatialInertia spatial_inertia(btScalar mass_kg, const btVector3& moments_kg_m2, const btMatrix3x3& axes,
                                      const btVector3& com_m) {
  const btVector3 c = com_m * mass_kg;
  const btVector3 rows[3] = {axes[0] * moments_kg_m2, axes[1] * moments_kg_m2, axes[2] * moments_kg_m2};
  return {mass_kg,
          c,
          rows[0].dot(axes[0]) + c.y() * com_m.y() + c.z() * com_m.z(),
          rows[1].dot(axes[1]) + c.x() * com_m.x() + c.z() * com_m.z(),
          rows[2].dot(axes[2]) + c.x() * com_m.x() + c.y() * com_m.y(),
          rows[0].dot(axes[1]) - c.x() * com_m.y(),
          rows[0].dot(axes[2]) - c.x() * com_m.z(),
          rows[1].dot(axes[2]) - c.y() * com_m.z()};
}

// Which degrees of freedom move which links: the constant structure of a multibody's joint-space inertia.
//
// The base has degrees of freedom 0..5: its angular velocity, then the velocity of its centre of mass, in world axes.
// Each joint of one degree of freedom follows, in the order of the links; a fixed joint has none. The path of a degree
// of freedom is the list of all degrees of freedom that carry it, from the base to itself; the path of a link is that
// of its joint. A path begins with the base's six. Each beginning of a path is a path itself: that of its last degree
// of freedom. A row of the joint-space inertia has entries only along its path, so it can be stored as a dense array
// (TreeFactor).
inline constexpr int base_dofs = 6;

struct Path {
  const int* dofs = nullptr;
  int length = 0;
};

class TreeShape {
 public:
  explicit TreeShape(const btMultiBody& body);

  int dof_count() const { return static_cast<int>(rows_.size()); }
  int link_count() const { return static_cast<int>(links_.size()) - 1; }
  // -1 is the base.
  int parent(int link) const { return at(link).parent; }
  int dof(int link) const { return at(link).dof; }  // its joint's, or -1 when it is fixed
  Path link_path(int link) const { return path(at(link).last_dof); }
  Path path(int dof) const {
    const Row& row = rows_[static_cast<std::size_t>(dof)];
    return {&dofs_[static_cast<std::size_t>(row.start)], row.length};
  }
  // Where the row of a degree of freedom begins when all are stored one after the other.
  int row_start(int dof) const { return rows_[static_cast<std::size_t>(dof)].start; }
  int entry_count() const { return static_cast<int>(dofs_.size()); }
  // What stands on the path of `dof` and not on that of `other`; a path's end.
  Path beyond(int dof, int other) const;

 private:
  struct Link {
    int parent = -1, dof = -1, last_dof = base_dofs - 1;
  };
  struct Row {
    int start = 0, length = 0;
  };

  const Link& at(int link) const { return links_[static_cast<std::size_t>(link + 1)]; }
  void add_row(int parent_dof);

  std::vector<Link> links_;  // the base first
  std::vector<Row> rows_;
  std::vector<int> dofs_;  // all paths
};

// The joint-space inertia M of a tree and its sparse factor.
//
// M has an entry only where one degree of freedom carries the other, and M = L^T D L with L as sparse as M itself:
// going from the leaves to the base, eliminating row k touches only rows of degrees of freedom on k's path (RBDA 6.5
// and table 6.3). For each degree of freedom its row along its path is stored (TreeShape), diagonal last. The path
// of the p-th degree of freedom on k's path is the beginning of k's own path, so all inner loops run over dense arrays.
//
// Solving is done in halves. With G = D^-1/2 L^-T, M^-1 = G^T G, so
//     y = G J^T  gives  J M^-1 J^T = y . y,
// and y has entries only on the path of the link that J belongs to: a row of a contact needs a dozen numbers, not the
// whole robot.
// Impulses p of many rows add up in z = sum of y p, and one second half, G^T z, turns them into joint velocities.
class TreeFactor {
 public:
  explicit TreeFactor(const TreeShape& shape);  // keeps a reference

  // To be filled before factorise(): entries of the row of a degree of freedom along its path, diagonal last.
  btScalar* row(int dof) { return &entries_[static_cast<std::size_t>(shape_->row_start(dof))]; }
  void factorise();

  // y along the path of `dof` <- G y.
  void first_half(int dof, btScalar* y) const;
  void first_half(int dof, std::array<btScalar, 4>* y) const;  // four at once
  // The same for a vector of all degrees of freedom.
  void first_half(btScalar* y) const;
  // x <- G^T x, all degrees of freedom.
  void second_half(btScalar* x) const;

 private:
  const btScalar* row(int dof) const { return &entries_[static_cast<std::size_t>(shape_->row_start(dof))]; }
  btScalar scale(int dof) const { return scales_[static_cast<std::size_t>(dof)]; }

  const TreeShape* shape_;
  std::vector<btScalar> entries_;  // of M, then of L
  std::vector<btScalar> scales_;   // D^-1/2
};

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
  // The same for an impulse along a coordinate, on the path of its joint, and behind it on what the carrier's path has
  // beyond it. Then `scratch` has room for the carrier's path.
  void response(const Coordinate& along, btScalar* y, btScalar* scratch) const;

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
