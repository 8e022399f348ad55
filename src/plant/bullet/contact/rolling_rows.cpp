#include "rolling_rows.h"

#include "plant/bullet/joint/joint_rows.h"

namespace kadans::bullet {

RollingRows::RollingRows(btMultiBody& body)
    : btMultiBodyConstraint(&body, nullptr, -1, -1, 3, false, MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR) {
  allocateJacobiansMultiDof();
}

void RollingRows::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                       const btContactSolverInfo&) {
  for (int axis = 0; axis < 3; ++axis) {
    internalSetAppliedImpulse(axis, 0);  // starts from nothing: rolling and lying still are far apart
    if (!(limit_Nms_ > 0)) continue;
    double response = 0;
    btMultiBodySolverConstraint row = coordinate_row(*m_bodyA, -1, {.joint = axis}, data, response);
    row.m_jacDiagABInv = 1 / response;
    row.m_rhs = -m_bodyA->getVelocityVector()[axis] / response;
    row.m_cfm = 0;
    row.m_lowerLimit = -limit_Nms_;
    row.m_upperLimit = limit_Nms_;
    row.m_orgConstraint = this;
    row.m_orgDofIndex = axis;
    rows.push_back(row);
  }
}

}  // namespace kadans::bullet
