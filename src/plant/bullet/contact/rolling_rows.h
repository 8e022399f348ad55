// Resistance against rolling and spinning of one free body: a torque against its angular velocity, at most
// lever arm * normal force. It acts within the solver, so that a body at rest stays at rest. The normal force is that
// of the last step. There is one row about each world axis. While the body turns, they share the limit as its angular
// velocity has them, so that it is slowed along its way and not bent off it.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace kadans::bullet {

class RollingRows final : public btMultiBodyConstraint {
 public:
  explicit RollingRows(btMultiBody& body);

  // For the next step. 0: no rows.
  void set_limit(double impulse_Nms) { limit_Nms_ = impulse_Nms; }
  double limit_Nms(int axis) const;  // as the body turns now
  btMultiBody& body() { return *m_bodyA; }

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  void finalizeMultiDof() override {}
  int getIslandIdA() const override { return 0; }
  int getIslandIdB() const override { return 0; }
  void debugDraw(btIDebugDraw*) override {}

 private:
  double limit_Nms_ = 0;
};

}  // namespace kadans::bullet
