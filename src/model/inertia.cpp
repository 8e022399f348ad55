#include "kadans/model/inertia.h"

#include <array>

#include <Eigen/Eigenvalues>

#include "kadans/model/kinematics.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Matrix3 = std::array<Vec3, 3>;  // rows

Matrix3 tensor(const Inertia& i) noexcept {
  return {Vec3{i.xx, i.xy, i.xz}, Vec3{i.xy, i.yy, i.yz}, Vec3{i.xz, i.yz, i.zz}};
}

void set_tensor(Inertia& i, const Matrix3& m) noexcept {
  i.xx = m[0][0], i.yy = m[1][1], i.zz = m[2][2], i.xy = m[0][1], i.xz = m[0][2], i.yz = m[1][2];
}

// R I R^T, as R applied to the columns of I, then to the columns of the transposed result.
Matrix3 turned(const Matrix3& m, const Quat& q) noexcept {
  Matrix3 once, twice;
  for (std::size_t i = 0; i < 3; ++i) once[i] = rotate(q, m[i]);  // m is symmetric: its rows are its columns
  for (std::size_t i = 0; i < 3; ++i) twice[i] = rotate(q, {once[0][i], once[1][i], once[2][i]});
  return twice;
}

// Adds a point mass at `offset` from the reference point.
void add_point(Inertia& i, double mass_kg, const Vec3& d) noexcept {
  i.xx += mass_kg * (d[1] * d[1] + d[2] * d[2]);
  i.yy += mass_kg * (d[0] * d[0] + d[2] * d[2]);
  i.zz += mass_kg * (d[0] * d[0] + d[1] * d[1]);
  i.xy -= mass_kg * d[0] * d[1];
  i.xz -= mass_kg * d[0] * d[2];
  i.yz -= mass_kg * d[1] * d[2];
}

std::string moments(const Eigen::Vector3d& m) { return printed("%.4g, %.4g, %.4g", m[0], m[1], m[2]); }

}  // namespace

Inertia moved(const Inertia& inertia, const Pose& pose) noexcept {
  Inertia result = inertia;
  result.com_m = transform(pose, inertia.com_m);
  set_tensor(result, turned(tensor(inertia), pose.orientation));
  return result;
}

Inertia scaled(const Inertia& inertia, double factor) noexcept {
  Inertia result = inertia;
  for (double* const part : {&result.mass_kg, &result.xx, &result.yy, &result.zz, &result.xy, &result.xz, &result.yz})
    *part *= factor;
  return result;
}

Inertia combined(const Inertia& a, const Inertia& b) noexcept {
  if (!(b.mass_kg > 0)) return a;
  if (!(a.mass_kg > 0)) return b;
  Inertia sum;
  sum.mass_kg = a.mass_kg + b.mass_kg;
  for (std::size_t k = 0; k < 3; ++k) {
    sum.com_m[k] = (a.mass_kg * a.com_m[k] + b.mass_kg * b.com_m[k]) / sum.mass_kg;
  }
  for (const Inertia* part : {&a, &b}) {
    sum.xx += part->xx, sum.yy += part->yy, sum.zz += part->zz;
    sum.xy += part->xy, sum.xz += part->xz, sum.yz += part->yz;
    add_point(sum, part->mass_kg,
              {part->com_m[0] - sum.com_m[0], part->com_m[1] - sum.com_m[1], part->com_m[2] - sum.com_m[2]});
  }
  return sum;
}

std::optional<std::string> inertia_defect(const Inertia& inertia, double rounding) {
  constexpr double singular = 1e-9;  // relative to the largest principal moment
  Eigen::Matrix3d m;
  m << inertia.xx, inertia.xy, inertia.xz, inertia.xy, inertia.yy, inertia.yz, inertia.xz, inertia.yz, inertia.zz;
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(principal[0] > singular * principal[2])) {
    return "is not positive definite: its principal moments are " + moments(principal) + " kg m2, all must be > 0";
  }
  if (!(principal[0] + principal[1] >= principal[2] * (1 - rounding))) {
    return "breaks the triangle inequality: of its principal moments " + moments(principal) +
           " kg m2 no one may exceed the sum of the other two, here " + printed("%.4g", principal[0] + principal[1]);
  }
  return std::nullopt;
}

}  // namespace kadans
