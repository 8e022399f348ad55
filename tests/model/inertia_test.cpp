#include "kadans/model/inertia.h"

#include <cmath>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"

using namespace kadans;

namespace {

// A solid box about its centre of mass, which lies at `com_m`.
Inertia box(double mass_kg, const Vec3& size_m, const Vec3& com_m = {}) {
  const auto square = [&](std::size_t k) { return size_m[k] * size_m[k]; };
  Inertia i;
  i.mass_kg = mass_kg;
  i.com_m = com_m;
  i.xx = mass_kg / 12 * (square(1) + square(2));
  i.yy = mass_kg / 12 * (square(0) + square(2));
  i.zz = mass_kg / 12 * (square(0) + square(1));
  return i;
}

void check_same(const Inertia& a, const Inertia& b) {
  CHECK(a.mass_kg == doctest::Approx(b.mass_kg));
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(a.com_m[k] - b.com_m[k]) < 1e-12);
  CHECK(std::abs(a.xx - b.xx) < 1e-12);
  CHECK(std::abs(a.yy - b.yy) < 1e-12);
  CHECK(std::abs(a.zz - b.zz) < 1e-12);
  CHECK(std::abs(a.xy - b.xy) < 1e-12);
  CHECK(std::abs(a.xz - b.xz) < 1e-12);
  CHECK(std::abs(a.yz - b.yz) < 1e-12);
}

}  // namespace

TEST_CASE("Two halves of a box welded together have the inertia of the whole") {
  const Inertia left = box(3, {0.4, 0.1, 0.6}, {1, 2.05, 3}), right = box(3, {0.4, 0.1, 0.6}, {1, 1.95, 3});
  check_same(combined(left, right), box(6, {0.4, 0.2, 0.6}, {1, 2, 3}));
}

TEST_CASE("A body without mass adds nothing, on either side") {
  const Inertia body = box(3, {0.4, 0.1, 0.6}, {1, 2, 3});
  check_same(combined(body, {}), body);
  check_same(combined({}, body), body);
}

TEST_CASE("A box turned by a quarter about z has its x and y exchanged, and its centre of mass moves along") {
  const Inertia turned = moved(box(3, {0.4, 0.1, 0.6}, {1, 0, 0}), {{0, 0, 5}, from_axis_angle({0, 0, 1}, M_PI / 2)});
  check_same(turned, box(3, {0.1, 0.4, 0.6}, {0, 1, 5}));
}

TEST_CASE("Two point masses off the axes have the products of inertia of the textbook") {
  Inertia a, b;  // m r r^T with r = +-(1, 2, 3): xy = -m x y summed
  a.mass_kg = b.mass_kg = 2;
  a.com_m = {1, 2, 3};
  b.com_m = {-1, -2, -3};
  const Inertia sum = combined(a, b);
  CHECK(sum.xx == doctest::Approx(4 * (4 + 9)));
  CHECK(sum.xy == doctest::Approx(-4 * 2));
  CHECK(sum.xz == doctest::Approx(-4 * 3));
  CHECK(sum.yz == doctest::Approx(-4 * 6));
}

TEST_CASE("A turned tensor keeps its principal moments: turning back gives the first") {
  const Quat q = from_roll_pitch_yaw(0.3, -0.8, 1.9);
  const Inertia body = box(3, {0.4, 0.1, 0.6}, {1, 2, 3});
  const Inertia there = moved(body, {{}, q});
  CHECK(std::abs(there.xy) > 1e-3);
  CHECK(there.xx + there.yy + there.zz == doctest::Approx(body.xx + body.yy + body.zz));
  check_same(moved(there, {{}, conjugate(q)}), body);
}

TEST_CASE("A thin plate may have one moment equal to the sum of the other two, more than rounding it may not") {
  const auto with_moments = [](double xx, double yy, double zz) {
    Inertia i;
    i.xx = xx, i.yy = yy, i.zz = zz;
    return i;
  };
  CHECK_FALSE(inertia_defect(with_moments(0.1, 0.2, 0.3)));
  CHECK_FALSE(inertia_defect(with_moments(0.1, 0.2, 0.30001)));
  CHECK(inertia_defect(with_moments(0.1, 0.2, 0.3002)));
  CHECK(inertia_defect(with_moments(0.1, 0.2, -0.1)));
  CHECK(inertia_defect(with_moments(0, 0.2, 0.2)));
}
