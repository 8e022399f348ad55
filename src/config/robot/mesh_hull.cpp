#include "mesh_hull.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "kadans/signal/content_hash.h"
#include "project_root.h"
#include "realtime/machine/child_process.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t hull_version = 1;  // another one when the same file gives another hull

fs::path hull_program() {
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path();
  // Installed, it stands in libexec; of a build, beside the program or above those of tests.
  for (const fs::path& folder : {beside.parent_path() / "libexec", beside, beside.parent_path()}) {
    if (fs::exists(folder / "kadans-hull", error)) return folder / "kadans-hull";
  }
  return {};
}

// nullopt when the text is not what the program writes.
std::optional<std::vector<Vec3>> corners_in(std::string_view text) {
  const auto json = read_foreign_json(text);
  if (!json || !json->is_object()) return std::nullopt;
  const auto list = json->find("corners");
  if (list == json->end() || !list->is_array() || list->empty() || list->size() > mesh_corners_max) return std::nullopt;
  std::vector<Vec3> corners;
  for (const auto& corner : *list) {
    if (!corner.is_array() || corner.size() != 3) return std::nullopt;
    Vec3 point{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!corner[i].is_number()) return std::nullopt;
      point[i] = corner[i].get<double>();
      if (!std::isfinite(point[i])) return std::nullopt;
    }
    corners.push_back(point);
  }
  return corners;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

[[noreturn]] void refuse_mesh(const std::string& file, const ProgramOutput& made) {
  std::string why = shown_text(std::string_view(made.err).substr(0, made.err.find('\n')));
  if (why.empty()) why = "its reader ended without a word";
  refuse(file, "cannot be read as a mesh: " + why);
}

void keep(const fs::path& file, std::string_view text) {
  try {
    fs::create_directories(file.parent_path());
    write_durably(file, text);
  } catch (const std::exception&) {  // it is read again the next time
  }
}

}  // namespace

std::vector<Vec3> mesh_hull(const std::string& file) {
  ContentHash hash;
  hash.add(hull_version);
  hash.add(mesh_corners_max);
  hash.add(fs::path(file).extension().string());  // by which its format is known
  hash.add_file(file);
  const fs::path folder = user_folder("XDG_CACHE_HOME", ".cache");
  const fs::path kept = folder / "hulls" / (hash.hex() + ".json");
  if (!folder.empty()) {
    if (const auto corners = corners_in(read_text(kept))) return *corners;
  }
  const fs::path program = hull_program();
  if (program.empty()) return {};
  const ProgramOutput made =
      run_program({program.string(), fs::absolute(file).string(), std::to_string(mesh_corners_max)});
  const auto corners = made.exit_code == 0 ? corners_in(made.out) : std::nullopt;
  if (!corners) refuse_mesh(file, made);
  if (!folder.empty()) keep(kept, made.out);
  return *corners;
}

std::vector<MeshTriangle> mesh_triangles(const std::string& file) {
  const fs::path program = hull_program();
  if (program.empty()) return {};
  const ProgramOutput made = run_program({program.string(), fs::absolute(file).string(), "triangles"});
  if (made.exit_code != 0 || made.out.empty() || made.out.size() % sizeof(MeshTriangle) != 0) refuse_mesh(file, made);
  std::vector<MeshTriangle> triangles(made.out.size() / sizeof(MeshTriangle));
  std::memcpy(triangles.data(), made.out.data(), made.out.size());
  for (const MeshTriangle& triangle : triangles) {
    for (const float part : triangle)
      if (!std::isfinite(part)) refuse_mesh(file, made);
  }
  return triangles;
}

}  // namespace kadans
