// Where the meshes of a URDF are.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "kadans/model/urdf.h"
#include "model/xml_scan.h"
#include "urdf_description.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> if_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  return path.lexically_normal().string();
}

// The <name> in a folder's package.xml; "" when there is none.
std::string package_in(const fs::path& folder) {
  std::array<char, 4096> start{};
  std::ifstream in(folder / "package.xml", std::ios::binary);
  in.read(start.data(), start.size());
  const std::string_view text(start.data(), static_cast<std::size_t>(in.gcount()));
  const std::size_t at = text.find("<name>");
  if (at == std::string_view::npos) return "";
  return std::string(trimmed(text.substr(at + 6, text.find('<', at + 1) - at - 6)));
}

// The folders of the package that lie here: in this folder, and this folder itself.
std::vector<fs::path> packages_at(const fs::path& folder, const fs::path& package) {
  std::vector<fs::path> here;
  std::error_code error;
  if (fs::is_directory(folder / package, error)) here.push_back(folder / package);
  if (folder.filename() == package || package_in(folder) == package) here.push_back(folder);
  return here;
}

// The folders that ROS_PACKAGE_PATH names and those in them; the share folders of AMENT_PREFIX_PATH.
std::vector<fs::path> package_folders() {
  std::vector<fs::path> folders;
  const auto add_each = [&](const char* variable, const auto& add) {
    const char* const value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nothing sets it
    std::string_view rest = value == nullptr ? "" : value;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(':'), rest.size());
      if (end > 0) add(fs::path(rest.substr(0, end)));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  };
  add_each("ROS_PACKAGE_PATH", [&](const fs::path& folder) {
    folders.push_back(folder);
    std::error_code error;
    std::vector<fs::path> below;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
      if (at->is_directory(error)) below.push_back(at->path());
    std::ranges::sort(below);
    folders.insert(folders.end(), below.begin(), below.end());
  });
  add_each("AMENT_PREFIX_PATH", [&](const fs::path& folder) { folders.push_back(folder / "share"); });
  return folders;
}

// Where the package may be, the likeliest first; `start` is the URDF's folder.
std::vector<fs::path> folders_of_package(const std::string& package, const fs::path& start,
                                         const UrdfPackages& packages) {
  if (const auto given = packages.find(package); given != packages.end()) return {given->second};
  std::vector<fs::path> all;
  const auto add_at = [&](const fs::path& folder) {
    for (fs::path& one : packages_at(folder, package)) all.push_back(std::move(one));
  };
  for (const fs::path& folder : package_folders()) add_at(folder);
  for (fs::path folder = start;; folder = folder.parent_path()) {
    add_at(folder);
    if (folder == folder.parent_path()) return all;
  }
}

fs::path folder_of(const std::string& urdf_file) {
  std::error_code error;
  return fs::absolute(fs::path(urdf_file), error).parent_path();
}

std::optional<std::string> in_package(const UrdfPackagePath& path, const fs::path& start,
                                      const UrdfPackages& packages) {
  if (path.inside.empty()) return std::nullopt;
  if (path.package.empty()) return if_file(start / path.inside);
  for (const fs::path& folder : folders_of_package(path.package, start, packages)) {
    if (auto found = if_file(folder / path.inside)) return found;
  }
  if (packages.contains(path.package)) return std::nullopt;
  // A copy of the package whose folder has another name, and no package.xml that says it is another one.
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (auto found = if_file(folder / path.inside); found && package_in(folder).empty()) return found;
    if (folder == folder.parent_path()) break;
  }
  // No package after all: package:///FOLDER/FILE lies beside the URDF.
  return path.rooted ? if_file(start / path.package / path.inside) : std::nullopt;
}

}  // namespace

std::optional<UrdfPackagePath> urdf_package_path(std::string_view name) {
  for (const std::string_view scheme : {"package://", "model://"}) {
    if (!name.starts_with(scheme)) continue;
    name.remove_prefix(scheme.size());
    const std::size_t start = std::min(name.find_first_not_of('/'), name.size());
    name.remove_prefix(start);  // package:///NAME is written, too
    const std::size_t end = name.find('/');
    if (end == std::string_view::npos) return UrdfPackagePath{.inside = std::string(name), .rooted = start > 0};
    return UrdfPackagePath{
        .package = std::string(name.substr(0, end)), .inside = std::string(name.substr(end + 1)), .rooted = start > 0};
  }
  return std::nullopt;
}

std::optional<std::string> find_urdf_package(const std::string& package, const std::string& urdf_file,
                                             const UrdfPackages& packages) {
  const std::vector<fs::path> found = folders_of_package(package, folder_of(urdf_file), packages);
  if (found.empty()) return std::nullopt;
  return found.front().lexically_normal().string();
}

std::optional<std::string> find_urdf_file(const std::string& name, const std::string& urdf_file,
                                          const UrdfPackages& packages) {
  constexpr std::string_view file = "file://";
  if (name.starts_with(file)) return if_file(name.substr(file.size()));
  const fs::path folder = folder_of(urdf_file);
  if (const auto path = urdf_package_path(name)) return in_package(*path, folder, packages);
  return if_file(folder / name);
}

}  // namespace kadans
