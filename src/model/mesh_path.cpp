#include "mesh_path.h"

#include <filesystem>

namespace kadans {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> if_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  return path.lexically_normal().string();
}

std::optional<std::string> in_package(const std::string& rest, const fs::path& start) {
  const std::size_t slash = rest.find('/');
  if (slash == 0 || slash == std::string::npos) return std::nullopt;
  const fs::path package = rest.substr(0, slash), inside = rest.substr(slash + 1);
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (folder.filename() == package) {
      if (auto found = if_file(folder / inside)) return found;
    }
    if (auto found = if_file(folder / package / inside)) return found;
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

}  // namespace

std::optional<std::string> find_mesh(const std::string& name_in_urdf, const std::string& urdf_file) {
  const std::string package = "package://", file = "file://";
  if (name_in_urdf.starts_with(file)) return if_file(name_in_urdf.substr(file.size()));
  std::error_code error;
  const fs::path folder = fs::absolute(fs::path(urdf_file), error).parent_path();
  if (name_in_urdf.starts_with(package)) return in_package(name_in_urdf.substr(package.size()), folder);
  return if_file(folder / name_in_urdf);
}

}  // namespace kadans
