// What acts on one joint, or on two joints along the coordinate of a drive that moves both, and must be implicit or
// one-sided, so that the solver has to do it. Bullet's core has no armature, no joint damping and no usable joint
// limit.
//
// A row is a law for the impulse p on the joint over a step, as a function of the joint velocity v at the step's end:
//     p = clamp(a - b v, lower, upper)
// With the response d of v to a unit impulse, the solver's iteration p += (a - b v - p) / (1 + b d) converges to that
// law; in Bullet's terms: m_jacDiagABInv = b / (1 + b d), m_rhs = (a - b v0) / (1 + b d), m_cfm = 1 / (1 + b d). A
// stiff row (b -> infinity) asks for a velocity: m_jacDiagABInv = 1 / d, m_rhs = (v_wanted - v0) / d, m_cfm = 0.
//
//   rotor inertia J         p = J (v_old - v)                            a = J v_old,  b = J
//   damper c                p = -dt c v                                  a = 0,        b = dt c
//   spring k about r        p = dt k (r - q - dt v)                      a = dt k (r - q),  b = dt^2 k
//   servo kp, kd            p = dt (kp (q_d - q - dt v) + kd (v_d - v)), limited to the drive's torque
//   dry friction            stiff, v_wanted = 0, limited to dt times the friction torque
//   tie of two joints       stiff, without limits: a part (tie_erp) of what they are apart is taken back each step
//   joint limit             stiff, one-sided: v may just reach the limit at the step's end; when beyond, a small part
//                           (limit_erp) of the excess is taken back each step, slowly, so that nothing is thrown out
// Here they are rows of Bullet's stock solver. All rows of a joint share one Jacobian and one articulated-body pass for
// the response. solver/tree_solver.h uses the laws alone.
#pragma once

#include <array>
#include <cstdint>

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include "plant/bullet/solver/joint_law.h"

namespace kadans::bullet {

inline constexpr double limit_erp = 0.05, tie_erp = 0.2;

struct TorqueLaw;  // drive.h

// A row of Bullet's stock solver about one coordinate of one body, without its law. The coordinate counts 0..5 for the
// base, then the joints. `link`: the link that it belongs to, -1 for the base. `response`: the change of the
// coordinate's velocity by a unit impulse along it.
btMultiBodySolverConstraint coordinate_row(btMultiBody& body, int link, const Coordinate& coordinate,
                                           btMultiBodyJacobianData& data, double& response);

class JointRows final : public btMultiBodyConstraint {
 public:
  enum Kind : std::uint8_t { linear, servo, friction, limit };

  JointRows(btMultiBody& body, const Coordinate& coordinate, double lower_rad, double upper_rad);

  // Each holds for the next step only; call clear() first.
  void clear() { active_.fill(false); }
  void set_linear(double impulse_at_rest, double slope);
  void set_servo(double impulse_at_rest, double slope, double lower, double upper);
  void set_friction(double impulse_max);
  void set_tie(double wanted_rad_s);

  // The laws of this step, for a solver of our own. begin_step decides about the joint's limit.
  void begin_step(double dt_s) { activate_limit(dt_s); }
  btMultiBody& body() { return *m_bodyA; }
  const Coordinate& coordinate() const { return coordinate_; }  // of links
  bool active(Kind kind) const { return active_[kind]; }
  const JointLaw& law(Kind kind) const { return laws_[kind]; }
  double last_impulse(Kind kind) const { return impulses_at(kind); }
  void set_impulse(Kind kind, double impulse) { internalSetAppliedImpulse(kind, impulse); }
  // Whether the servo gave all it could in the last step.
  bool servo_at_limit() const { return servo_at_limit_; }
  void set_servo_at_limit(bool at_limit) { servo_at_limit_ = at_limit; }

  // What each row did in the last step, as impulses; 0 when it was not active.
  double impulse(Kind kind) const { return active_[kind] ? impulses_at(kind) : 0; }

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  void finalizeMultiDof() override {}
  int getIslandIdA() const override { return 0; }
  int getIslandIdB() const override { return 0; }
  void debugDraw(btIDebugDraw*) override {}

 private:
  double impulses_at(Kind kind) const { return m_data[kind]; }
  double above_lower_rad() const { return m_bodyA->getJointPos(m_linkA) - lower_rad_; }
  double below_upper_rad() const { return upper_rad_ - m_bodyA->getJointPos(m_linkA); }
  void activate_limit(double dt_s);

  Coordinate coordinate_;
  double lower_rad_, upper_rad_;  // infinite for the coordinate of two joints
  std::array<bool, 4> active_{};
  std::array<JointLaw, 4> laws_{};
  bool servo_at_limit_ = false;
};

}  // namespace kadans::bullet
