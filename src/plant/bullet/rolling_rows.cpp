#include "rolling_rows.h"

namespace kadans::bullet {

RollingRows::RollingRows(btMultiBody& body)
    : btMultiBodyConstraint(&body, nullptr, -1, -1, 3, false, MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR) {
  allocateJacobiansMultiDof();
}

btMultiBodySolverConstraint RollingRows::row(btMultiBodyJacobianData& data, int axis) const {
  btMultiBodySolverConstraint row;
  const int dofs = m_bodyA->getNumDofs() + 6;
  row.m_multiBodyA = m_bodyA;
  row.m_linkA = -1;
  row.m_deltaVelAindex = m_bodyA->getCompanionId();
  if (row.m_deltaVelAindex < 0) {
    row.m_deltaVelAindex = data.m_deltaVelocities.size();
    m_bodyA->setCompanionId(row.m_deltaVelAindex);
    data.m_deltaVelocities.resize(row.m_deltaVelAindex + dofs, 0);
  }
  row.m_jacAindex = data.m_jacobians.size();
  row.m_deltaVelBindex = row.m_jacBindex = -1;
  data.m_jacobians.resize(row.m_jacAindex + dofs, 0);
  data.m_deltaVelocitiesUnitImpulse.resize(row.m_jacAindex + dofs, 0);
  data.m_jacobians[row.m_jacAindex + axis] = 1;
  m_bodyA->calcAccelerationDeltasMultiDof(&data.m_jacobians[row.m_jacAindex],
                                          &data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex], data.scratch_r,
                                          data.scratch_v);
  const double response = data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex + axis];
  row.m_relpos1CrossNormal = row.m_contactNormal1 = row.m_relpos2CrossNormal = row.m_contactNormal2 =
      row.m_angularComponentA = row.m_angularComponentB = btVector3(0, 0, 0);
  row.m_appliedImpulse = row.m_appliedPushImpulse = 0;
  row.m_friction = row.m_rhsPenetration = 0;
  row.m_originalContactPoint = nullptr;
  row.m_overrideNumSolverIterations = row.m_frictionIndex = -1;
  row.m_jacDiagABInv = 1 / response;
  row.m_rhs = -m_bodyA->getVelocityVector()[axis] / response;
  row.m_cfm = 0;
  return row;
}

void RollingRows::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                       const btContactSolverInfo&) {
  for (int axis = 0; axis < 3; ++axis) {
    internalSetAppliedImpulse(axis, 0);  // starts from nothing: rolling and lying still are far apart
    if (!(limit_Nms_ > 0)) continue;
    btMultiBodySolverConstraint made = row(data, axis);
    made.m_lowerLimit = -limit_Nms_;
    made.m_upperLimit = limit_Nms_;
    made.m_orgConstraint = this;
    made.m_orgDofIndex = axis;
    rows.push_back(made);
  }
}

}  // namespace kadans::bullet
