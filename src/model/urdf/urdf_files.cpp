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

// A file of the package that this folder is, or that lies in it.
std::optional<std::string> in_folder(const fs::path& folder, const fs::path& package, const fs::path& inside) {
  if (auto found = if_file(folder / package / inside)) return found;
  if (folder.filename() != package && package_in(folder) != package) return std::nullopt;
  return if_file(folder / inside);
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

std::optional<std::string> in_package(std::string_view name, const fs::path& start, const UrdfPackages& packages) {
  name.remove_prefix(std::min(name.find_first_not_of('/'), name.size()));  // package:///NAME is written, too
  const fs::path rest = name;
  if (rest.empty()) return std::nullopt;
  const fs::path package = *rest.begin(), inside = rest.lexically_relative(package);
  if (const auto given = packages.find(package.string()); given != packages.end())
    return if_file(fs::path(given->second) / inside);
  for (const fs::path& folder : package_folders()) {
    if (auto found = in_folder(folder, package, inside)) return found;
  }
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (auto found = in_folder(folder, package, inside)) return found;
    if (folder == folder.parent_path()) break;
  }
  // A copy of the package whose folder has another name, and no package.xml that says it is another one.
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (auto found = if_file(folder / inside); found && package_in(folder).empty()) return found;
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

}  // namespace

std::optional<std::string> find_urdf_file(const std::string& name, const std::string& urdf_file,
                                          const UrdfPackages& packages) {
  constexpr std::string_view file = "file://";
  if (name.starts_with(file)) return if_file(name.substr(file.size()));
  std::error_code error;
  const fs::path folder = fs::absolute(fs::path(urdf_file), error).parent_path();
  for (const std::string_view package : {"package://", "model://"}) {
    if (name.starts_with(package)) return in_package(std::string_view(name).substr(package.size()), folder, packages);
  }
  return if_file(folder / name);
}

}  // namespace kadans
