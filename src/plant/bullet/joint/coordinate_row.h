// A row of Bullet's stock solver about one coordinate of one body, without its law.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include "plant/bullet/solver/joint_law.h"

namespace kadans::bullet {

// The coordinate counts 0..5 for the base, then the joints. `link`: the link that it belongs to, -1 for the base.
// `response`: the change of the coordinate's velocity by a unit impulse along it.
btMultiBodySolverConstraint coordinate_row(btMultiBody& body, int link, const Coordinate& coordinate,
                                           btMultiBodyJacobianData& data, double& response);

}  // namespace kadans::bullet
