#include "joint_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kadans::bullet {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double limit_return_rad_s = 0.5;
constexpr double limit_margin_rad = 0.05;  // nearer than this, or than a few steps' way, the limit's row is there

}  // namespace

JointRows::JointRows(btMultiBody& body, const Coordinate& coordinate, double lower_rad, double upper_rad)
    : btMultiBodyConstraint(&body, nullptr, coordinate.joint, -1, 4, false, MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR),
      coordinate_(coordinate),
      lower_rad_(lower_rad),
      upper_rad_(upper_rad) {
  allocateJacobiansMultiDof();
}

void JointRows::set_linear(double impulse_at_rest, double slope) {
  active_[linear] = slope > 0;
  laws_[linear] = {.at_rest = impulse_at_rest, .slope = slope, .lower = -infinite, .upper = infinite};
}

void JointRows::set_servo(double impulse_at_rest, double slope, double lower, double upper) {
  active_[servo] = slope > 0;
  laws_[servo] = {.at_rest = impulse_at_rest, .slope = slope, .lower = lower, .upper = upper};
}

void JointRows::set_friction(double impulse_max) {
  active_[friction] = impulse_max > 0;
  laws_[friction] = {.lower = -impulse_max, .upper = impulse_max, .stiff = true};
}

void JointRows::set_tie(double wanted_rad_s) {
  active_[friction] = true;
  laws_[friction] = {.lower = -infinite, .upper = infinite, .stiff = true, .wanted_rad_s = wanted_rad_s};
}

void JointRows::activate_limit(double dt_s) {
  const double margin = limit_margin_rad + 4 * dt_s * std::abs(m_bodyA->getJointVel(m_linkA));
  const double above = above_lower_rad(), below = below_upper_rad();
  active_[limit] = above < margin || below < margin;
  if (!active_[limit]) return;
  const bool at_lower = above < below;
  const double room = at_lower ? above : below;
  // How fast it may still go towards the limit; when beyond it, how fast it must come back, negated.
  const double away = room < 0 ? std::max(limit_erp * room / dt_s, -limit_return_rad_s) : room / dt_s;
  laws_[limit] = {.lower = at_lower ? 0 : -infinite,
                  .upper = at_lower ? infinite : 0,
                  .stiff = true,
                  .wanted_rad_s = at_lower ? -away : away};
}

void JointRows::createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                                     const btContactSolverInfo& info) {
  activate_limit(info.m_timeStep);
  double response = 0;
  btMultiBodySolverConstraint row;
  bool made = false;
  Coordinate along = coordinate_;
  along.joint = 6 + m_bodyA->getLink(m_linkA).m_dofOffset;
  double velocity = along.share * m_bodyA->getVelocityVector()[along.joint];
  if (along.carrier >= 0) {
    along.carrier = 6 + m_bodyA->getLink(along.carrier).m_dofOffset;
    velocity += along.carrier_share * m_bodyA->getVelocityVector()[along.carrier];
  }
  for (const Kind kind : {linear, servo, friction, limit}) {
    if (!active_[kind]) {
      internalSetAppliedImpulse(kind, 0);
      continue;
    }
    if (!made) row = coordinate_row(*m_bodyA, m_linkA, along, data, response);
    made = true;
    const JointLaw& law = laws_[kind];
    if (law.stiff) {
      row.m_jacDiagABInv = 1 / response;
      row.m_rhs = (law.wanted_rad_s - velocity) / response;
      row.m_cfm = 0;
    } else {
      const double scale = 1 / (1 + law.slope * response);
      row.m_jacDiagABInv = law.slope * scale;
      row.m_rhs = (law.at_rest - law.slope * velocity) * scale;
      row.m_cfm = scale;
    }
    row.m_lowerLimit = law.lower;
    row.m_upperLimit = law.upper;
    row.m_orgConstraint = this;
    row.m_orgDofIndex = kind;
    rows.push_back(row);
  }
}

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
