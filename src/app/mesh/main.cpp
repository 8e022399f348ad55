// The program kadans-hull, which reads a mesh for kadans. kadans-hull FILE CORNERS prints the convex hull as JSON,
// kadans-hull FILE triangles the corners of all triangles, nine numbers of the type float each, in this machine's
// bytes. It is a process of its own since files of meshes come from anywhere, and their reader is large.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>

#include "hull.h"

namespace kadans {
namespace {

[[maybe_unused]] constexpr rlim_t memory_max_bytes = rlim_t{1} << 31U;
constexpr rlim_t cpu_max_s = 60;
constexpr std::size_t corners_least = 4, corners_most = 256;
constexpr unsigned depth_max = 100;  // of nodes in nodes
constexpr std::size_t triangles_most = 1'000'000;

void bound(__rlimit_resource what, rlim_t most) {
  const rlimit limit{most, most};
  (void)setrlimit(what, &limit);
}

using Corner = std::array<float, 3>;

// What is drawn, where each mesh stands in the scene: its points, or the corners of its triangles, three each.
struct Contents {
  bool of_triangles = false;
  std::vector<btVector3> points;
  std::vector<Corner> corners;
};

Corner corner(const aiVector3D& point) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
    throw std::runtime_error("a point of it is no number");
  return {static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)};
}

void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, unsigned depth, Contents& to) {
  if (depth > depth_max) throw std::runtime_error("its nodes are nested too deep");
  const aiMatrix4x4 pose = above * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned k = 0; k < (to.of_triangles ? 0 : mesh.mNumVertices); ++k) {
      const auto [x, y, z] = corner(pose * mesh.mVertices[k]);
      to.points.emplace_back(static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z));
    }
    for (unsigned k = 0; k < (to.of_triangles ? mesh.mNumFaces : 0); ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;  // a point or a line
      if (to.corners.size() >= 3 * triangles_most) throw std::runtime_error("it has more than a million triangles");
      for (unsigned c = 0; c < 3; ++c) to.corners.push_back(corner(pose * mesh.mVertices[face.mIndices[c]]));
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], pose, depth + 1, to);
}

Contents read_mesh(const char* file, bool triangles) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // as ROS does: x y z are as they stand
  const aiScene* const scene = importer.ReadFile(
      file, aiProcess_ValidateDataStructure | (triangles ? static_cast<unsigned>(aiProcess_Triangulate) : 0U));
  if (scene == nullptr) throw std::runtime_error(importer.GetErrorString());
  Contents contents{.of_triangles = triangles};
  if (scene->mRootNode != nullptr) add_node(*scene, *scene->mRootNode, aiMatrix4x4(), 0, contents);
  if (triangles && contents.corners.empty()) throw std::runtime_error("it has no triangles");
  if (!triangles && contents.points.empty()) throw std::runtime_error("it has no points");
  return contents;
}

int run(int argc, char** argv) {
  const bool triangles = argc == 3 && std::string_view(argv[2]) == "triangles";
  const long corners = argc == 3 ? std::strtol(argv[2], nullptr, 10) : 0;
  if (!triangles && (corners < static_cast<long>(corners_least) || corners > static_cast<long>(corners_most))) {
    std::fprintf(stderr, "usage: kadans-hull FILE CORNERS, %zu to %zu, or kadans-hull FILE triangles\n", corners_least,
                 corners_most);
    return 2;
  }
#ifndef KADANS_SANITIZED  // a sanitizer's shadow of the memory is larger
  bound(RLIMIT_AS, memory_max_bytes);
#endif
  bound(RLIMIT_CPU, cpu_max_s);
  bound(RLIMIT_CORE, 0);
  const Contents contents = read_mesh(argv[1], triangles);
  if (triangles) {
    return std::fwrite(contents.corners.data(), sizeof(Corner), contents.corners.size(), stdout) ==
                   contents.corners.size()
               ? 0
               : 1;
  }
  const std::vector<btVector3> hull = convex_hull(contents.points, static_cast<std::size_t>(corners));
  std::printf("{\"corners\": [");
  for (const btVector3& corner : hull)
    std::printf("%s[%.17g, %.17g, %.17g]", &corner == hull.data() ? "" : ", ", corner.x(), corner.y(), corner.z());
  std::printf("]}\n");
  return 0;
}

}  // namespace
}  // namespace kadans

int main(int argc, char** argv) {
  try {
    return kadans::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
