// What is in the file of a mesh, by the program kadans-hull: the convex hull as which it collides, and its triangles.
#pragma once

#include <string>
#include <vector>

#include "kadans/model/urdf.h"

namespace kadans {

inline constexpr int mesh_corners_max = 32;

// The corners of the convex hull of what is in the file (STL, OBJ, Collada and what else assimp reads), in the file's
// unit: at most mesh_corners_max. They are kept by the file's content in ~/.cache/kadans/hulls (XDG_CACHE_HOME); where
// that cannot be written, the file is read again each time. Empty where the program is not installed. Throws InputError
// when the file is no mesh. Before anything moves: it reads files and starts a process.
std::vector<Vec3> mesh_hull(const std::string& file);

// All its triangles, at most a million. They are kept nowhere. Empty and throws as above.
std::vector<MeshTriangle> mesh_triangles(const std::string& file);

}  // namespace kadans
