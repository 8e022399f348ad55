#include "coordinate_row.h"

namespace kadans::bullet {

btMultiBodySolverConstraint coordinate_row(btMultiBody& body, int link, const Coordinate& coordinate,
                                           btMultiBodyJacobianData& data, double& response) {
  btMultiBodySolverConstraint row;
  const int dofs = body.getNumDofs() + 6;
  row.m_multiBodyA = &body;
  row.m_linkA = link;
  row.m_deltaVelAindex = body.getCompanionId();
  if (row.m_deltaVelAindex < 0) {
    row.m_deltaVelAindex = data.m_deltaVelocities.size();
    body.setCompanionId(row.m_deltaVelAindex);
    data.m_deltaVelocities.resize(row.m_deltaVelAindex + dofs, 0);
  }
  row.m_jacAindex = data.m_jacobians.size();
  row.m_deltaVelBindex = row.m_jacBindex = -1;
  data.m_jacobians.resize(row.m_jacAindex + dofs, 0);
  data.m_deltaVelocitiesUnitImpulse.resize(row.m_jacAindex + dofs, 0);
  const int own = row.m_jacAindex + coordinate.joint, carrier = row.m_jacAindex + coordinate.carrier;
  data.m_jacobians[own] = coordinate.share;
  if (coordinate.carrier >= 0) data.m_jacobians[carrier] = coordinate.carrier_share;
  body.calcAccelerationDeltasMultiDof(&data.m_jacobians[row.m_jacAindex],
                                      &data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex], data.scratch_r,
                                      data.scratch_v);
  response = coordinate.share * data.m_deltaVelocitiesUnitImpulse[own];
  if (coordinate.carrier >= 0) response += coordinate.carrier_share * data.m_deltaVelocitiesUnitImpulse[carrier];
  row.m_relpos1CrossNormal = row.m_contactNormal1 = row.m_relpos2CrossNormal = row.m_contactNormal2 =
      row.m_angularComponentA = row.m_angularComponentB = btVector3(0, 0, 0);
  row.m_appliedImpulse = row.m_appliedPushImpulse = 0;
  row.m_friction = row.m_rhsPenetration = 0;
  row.m_originalContactPoint = nullptr;
  row.m_overrideNumSolverIterations = row.m_frictionIndex = -1;
  return row;
}

}  // namespace kadans::bullet
