// A row of Bullet's stock solver about one coordinate of one body, without the law that it is to keep.
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace kadans::bullet {

// `coordinate`: 0..5 of the base, then those of the joints; `link`: whose it is, -1 of the base. `response`: what a
// unit impulse along the coordinate changes of its velocity.
btMultiBodySolverConstraint coordinate_row(btMultiBody& body, int link, int coordinate, btMultiBodyJacobianData& data,
                                           double& response);

}  // namespace kadans::bullet
