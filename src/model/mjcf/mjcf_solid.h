// The bodies of geoms: what shapes they are, and how MuJoCo weighs them.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/model/urdf.h"

namespace kadans {

struct MjcfSolid {
  std::vector<std::pair<Shape, double>> pieces;  // a shape, and how far along z it is
  Inertia inertia;                               // at a density of 1 kg/m3; no mass: it has no extent
};

// Sphere, box, cylinder, capsule and ellipsoid with half sizes, as an MJCF gives them. No pieces: another type.
MjcfSolid mjcf_primitive(const std::string& type, const std::array<double, 3>& size_m);

enum class MeshWeight : std::uint8_t { legacy, exact };

// The inertia of a mesh at a density of 1 kg/m3, as MuJoCo 2.2.2 has it, in the mesh's frame. Over each triangle stands
// a pyramid; its tip is the centre of the triangles' areas, later the centre of mass. `legacy`, MuJoCo's default,
// counts all pyramids as positive, which is right for convex meshes, and takes for the volume that of the box with the
// same moments at the same density of the pyramids. `exact` (exactmeshinertia) counts pyramids that point inwards as
// negative, which is right for closed ones. MuJoCo keeps corners as float, and so does this. No mass: the mesh has no
// volume.
Inertia mesh_inertia(const std::vector<MeshTriangle>& triangles, const Vec3& scale, MeshWeight weight);

}  // namespace kadans
