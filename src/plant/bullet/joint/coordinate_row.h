// A row of Bullet's stock solver about one coordinate of one body, without its law.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace kadans::bullet {

// `coordinate`: 0..5 of the base, then those of the joints. `link`: the link that the coordinate belongs to, -1 for the
// base. `response`: the change of the coordinate's velocity by a unit impulse along it.
btMultiBodySolverConstraint coordinate_row(btMultiBody& body, int link, int coordinate, btMultiBodyJacobianData& data,
                                           double& response);

}  // namespace kadans::bullet
