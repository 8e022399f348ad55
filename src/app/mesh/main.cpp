// The program kadans-hull, which reads a mesh for kadans: kadans-hull FILE CORNERS. It prints the convex hull as JSON.
// It is a process of its own since files of meshes come from anywhere, and their reader is large.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
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

void bound(__rlimit_resource what, rlim_t most) {
  const rlimit limit{most, most};
  (void)setrlimit(what, &limit);
}

void add_points(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, unsigned depth,
                std::vector<btVector3>& points) {
  if (depth > depth_max) throw std::runtime_error("its nodes are nested too deep");
  const aiMatrix4x4 pose = above * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
      const aiVector3D point = pose * mesh.mVertices[k];
      if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
        throw std::runtime_error("a point of it is no number");
      points.emplace_back(point.x, point.y, point.z);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_points(scene, *node.mChildren[i], pose, depth + 1, points);
}

std::vector<btVector3> read_points(const char* file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // as ROS does: x y z are as they stand
  const aiScene* const scene = importer.ReadFile(file, aiProcess_ValidateDataStructure);
  if (scene == nullptr) throw std::runtime_error(importer.GetErrorString());
  std::vector<btVector3> points;
  if (scene->mRootNode != nullptr) add_points(*scene, *scene->mRootNode, aiMatrix4x4(), 0, points);
  if (points.empty()) throw std::runtime_error("it has no points");
  return points;
}

int run(int argc, char** argv) {
  const long corners = argc == 3 ? std::strtol(argv[2], nullptr, 10) : 0;
  if (corners < static_cast<long>(corners_least) || corners > static_cast<long>(corners_most)) {
    std::fprintf(stderr, "usage: kadans-hull FILE CORNERS, %zu to %zu\n", corners_least, corners_most);
    return 2;
  }
#ifndef KADANS_SANITIZED  // a sanitizer's shadow of the memory is larger
  bound(RLIMIT_AS, memory_max_bytes);
#endif
  bound(RLIMIT_CPU, cpu_max_s);
  bound(RLIMIT_CORE, 0);
  const std::vector<btVector3> hull = convex_hull(read_points(argv[1]), static_cast<std::size_t>(corners));
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
