#include "mjcf_solid.h"

#include <cmath>
#include <numbers>

#include <Eigen/Dense>

namespace kadans {
namespace {

using Eigen::Vector3d;

constexpr double least = 1e-14;  // MuJoCo's, of areas, volumes and lengths

Inertia of_moments(double mass_kg, const Vec3& of_unit_mass) {
  Inertia body;
  body.mass_kg = mass_kg;
  body.xx = of_unit_mass[0] * mass_kg, body.yy = of_unit_mass[1] * mass_kg, body.zz = of_unit_mass[2] * mass_kg;
  return body;
}

struct Face {
  Vector3d normal, middle;
  double area = 0;
};

// Sums and differences of corners are taken as float, as the corners are.
Face face_of(const MeshTriangle& t) {
  Face face;
  Vector3d b, c;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const float sum = t[i] + t[3 + i] + t[6 + i];
    const float to_b = t[3 + i] - t[i], to_c = t[6 + i] - t[i];
    face.middle[k] = static_cast<double>(sum / 3), b[k] = static_cast<double>(to_b), c[k] = static_cast<double>(to_c);
  }
  face.normal = b.cross(c);
  const double length = face.normal.norm();
  if (length < least) {
    face.normal.setZero();
    return face;
  }
  face.normal /= length;
  face.area = length / 2;
  return face;
}

double counted(double volume, MeshWeight weight) { return weight == MeshWeight::legacy ? std::abs(volume) : volume; }

// The volume of the box with these moments (of a volume, at a density of 1).
double box_volume(const Eigen::Matrix3d& moments, double volume) {
  const Vector3d m =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues() / volume;
  const double half = m.sum() / 2;
  double box = 8;
  for (const double moment : m) box *= std::sqrt(std::max(0.0, 3 * (half - moment)));
  return box;
}

}  // namespace

MjcfSolid mjcf_primitive(const std::string& type, const std::array<double, 3>& size_m) {
  const auto [a, b, c] = size_m;
  constexpr double pi = std::numbers::pi;
  if (type == "sphere") {
    const double m = 0.4 * a * a;
    return {{{Sphere{a}, 0}}, of_moments(4.0 / 3 * pi * a * a * a, {m, m, m})};
  }
  const Box box{{2 * a, 2 * b, 2 * c}};
  const Vec3 squares{b * b + c * c, a * a + c * c, a * a + b * b};
  if (type == "box") {
    return {{{box, 0}}, of_moments(8 * a * b * c, {squares[0] / 3, squares[1] / 3, squares[2] / 3})};
  }
  if (type == "ellipsoid") {
    const Vec3 moments{squares[0] / 5, squares[1] / 5, squares[2] / 5};
    return {{{box, 0}}, of_moments(4.0 / 3 * pi * a * b * c, moments)};
  }
  if (type == "cylinder") {
    const double across = a * a / 4 + b * b / 3;
    return {{{Cylinder{a, 2 * b}, 0}}, of_moments(pi * a * a * 2 * b, {across, across, a * a / 2})};
  }
  if (type == "capsule") {
    const double tube = pi * a * a * 2 * b, ball = 4.0 / 3 * pi * a * a * a;
    const double t = tube / (tube + ball), s = ball / (tube + ball);
    // Two half balls, each 3/8 a beyond its end of the tube.
    const double across = t * (a * a / 4 + b * b / 3) + s * (0.4 * a * a + b * b + 0.75 * a * b);
    return {{{Cylinder{a, 2 * b}, 0}, {Sphere{a}, b}, {Sphere{a}, -b}},
            of_moments(tube + ball, {across, across, t * a * a / 2 + s * 0.4 * a * a})};
  }
  return {};
}

Inertia mesh_inertia(const std::vector<MeshTriangle>& triangles, const Vec3& scale, MeshWeight weight) {
  std::vector<MeshTriangle> faces = triangles;
  for (MeshTriangle& face : faces) {
    for (std::size_t i = 0; i < 9; ++i) face[i] = static_cast<float>(static_cast<double>(face[i]) * scale[i % 3]);
  }
  Vector3d tip = Vector3d::Zero();
  double area = 0;
  for (const MeshTriangle& corners : faces) {
    const Face face = face_of(corners);
    tip += face.area * face.middle, area += face.area;
  }
  if (!(area > least)) return {};
  tip /= area;
  Vector3d com = Vector3d::Zero();
  double volume = 0;
  for (const MeshTriangle& corners : faces) {
    const Face face = face_of(corners);
    const double pyramid = counted((face.middle - tip).dot(face.normal) * face.area / 3, weight);
    volume += pyramid;
    com += pyramid * (face.middle * 0.75 + tip * 0.25);
  }
  if (!(volume > least)) return {};
  com /= volume;
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  volume = 0;
  for (MeshTriangle& t : faces) {
    for (std::size_t i = 0; i < 9; ++i)
      t[i] = static_cast<float>(static_cast<double>(t[i]) - com[static_cast<Eigen::Index>(i % 3)]);
    const Face face = face_of(t);
    const double pyramid = counted(face.middle.dot(face.normal) * face.area / 3, weight);
    volume += pyramid;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = i; k < 3; ++k) {
        const float sum = 2 * (t[i] * t[k] + t[3 + i] * t[3 + k] + t[6 + i] * t[6 + k]) + t[i] * t[3 + k] +
                          t[k] * t[3 + i] + t[i] * t[6 + k] + t[k] * t[6 + i] + t[3 + i] * t[6 + k] +
                          t[3 + k] * t[6 + i];
        products(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) += pyramid / 20 * static_cast<double>(sum);
      }
    }
  }
  if (!(volume > least)) return {};
  const Eigen::Matrix3d whole = products.selfadjointView<Eigen::Upper>();
  const Eigen::Matrix3d moments = Eigen::Matrix3d::Identity() * whole.trace() - whole;
  Inertia body;
  body.mass_kg = weight == MeshWeight::legacy ? box_volume(moments, volume) : volume;
  body.com_m = {com[0], com[1], com[2]};
  const Eigen::Matrix3d m = moments * (body.mass_kg / volume);
  body.xx = m(0, 0), body.yy = m(1, 1), body.zz = m(2, 2), body.xy = m(0, 1), body.xz = m(0, 2), body.yz = m(1, 2);
  return body;
}

}  // namespace kadans
