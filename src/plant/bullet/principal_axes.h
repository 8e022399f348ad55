// Bullet takes a link's inertia as three moments about axes it expects to be the link's own, so each link gets a frame
// at its centre of mass along its principal axes. Jacobi rotations: exact to rounding, and identity for an inertia that
// is diagonal already.
#pragma once

#include <LinearMath/btTransform.h>

#include "kadans/model/robot_model.h"

namespace kadans::bullet {

struct PrincipalAxes {
  btMatrix3x3 rotation;  // columns: the axes, in the link's frame; right-handed
  btVector3 moments_kg_m2;
};

PrincipalAxes principal_axes(const Inertia& inertia);

}  // namespace kadans::bullet
