#include "rolling_rows.h"

#include <algorithm>
#include <cmath>

#include "plant/bullet/joint/joint_rows.h"

namespace kadans::bullet {

RollingRows::RollingRows(btMultiBody& body)
    : btMultiBodyConstraint(&body, nullptr, -1, -1, 3, false, MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR) {
  allocateJacobiansMultiDof();
}

double RollingRows::limit_Nms(int axis) const {
  constexpr double rest_rad_s = 0.1;  // slower than this, all axes are held more and more
  const btVector3 turn_rad_s = m_bodyA->getBaseOmega();
  const double speed_rad_s = turn_rad_s.length();
  const double own = speed_rad_s > 0 ? std::abs(turn_rad_s[axis]) / speed_rad_s : 0;
  return limit_Nms_ * std::max(own, 1 - speed_rad_s / rest_rad_s);
}

void RollingRows::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                       const btContactSolverInfo&) {
  for (int axis = 0; axis < 3; ++axis) {
    internalSetAppliedImpulse(axis, 0);  // starts from nothing: rolling and lying still are far apart
    const double limit_Nms = this->limit_Nms(axis);
    if (!(limit_Nms > 0)) continue;
    double response = 0;
    btMultiBodySolverConstraint row = coordinate_row(*m_bodyA, -1, {.joint = axis}, data, response);
    row.m_jacDiagABInv = 1 / response;
    row.m_rhs = -m_bodyA->getVelocityVector()[axis] / response;
    row.m_cfm = 0;
    row.m_lowerLimit = -limit_Nms;
    row.m_upperLimit = limit_Nms;
    row.m_orgConstraint = this;
    row.m_orgDofIndex = axis;
    rows.push_back(row);
  }
}

}  // namespace kadans::bullet
