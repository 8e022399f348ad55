#include "principal_axes.h"

#include <cmath>

namespace kadans::bullet {
namespace {

// One Jacobi rotation: makes a[p][q] zero and turns the axes with it.
void rotate_to_zero(btMatrix3x3& a, btMatrix3x3& axes, int p, int q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  btMatrix3x3 turn = btMatrix3x3::getIdentity();
  turn[p][p] = turn[q][q] = c;
  turn[p][q] = s;
  turn[q][p] = -s;
  a = turn.transpose() * a * turn;
  a[p][q] = a[q][p] = 0;
  axes = axes * turn;
}

}  // namespace

PrincipalAxes principal_axes(const Inertia& inertia) {
  btMatrix3x3 a(inertia.xx, inertia.xy, inertia.xz,  //
                inertia.xy, inertia.yy, inertia.yz,  //
                inertia.xz, inertia.yz, inertia.zz);
  btMatrix3x3 axes = btMatrix3x3::getIdentity();
  constexpr int sweeps = 12;  // converges quadratically: 3 x 3 needs 4 or 5
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    rotate_to_zero(a, axes, 0, 1);
    rotate_to_zero(a, axes, 0, 2);
    rotate_to_zero(a, axes, 1, 2);
  }
  return {axes, btVector3(a[0][0], a[1][1], a[2][2])};
}

}  // namespace kadans::bullet
