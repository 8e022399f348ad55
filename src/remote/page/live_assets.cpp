#include "live_assets.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "config/json/json_value.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view package = "package://";
constexpr std::size_t file_max_bytes = std::size_t{16} << 20U;

// A robot may come from anybody: of what its URDF names only meshes and their pictures are handed out.
bool is_mesh(const fs::path& file) {
  constexpr std::array<std::string_view, 9> kinds{".stl",  ".dae", ".obj", ".ply", ".glb",
                                                  ".gltf", ".mtl", ".png", ".jpg"};
  std::string kind = file.extension().string();
  for (char& c : kind) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::ranges::find(kinds, kind) != kinds.end();
}

// As the reader of the URDF finds it: from the file's folder, a package's folder from there up.
std::string place_of(const std::string& name, const fs::path& folder) {
  if (name.starts_with("file://")) return name.substr(7);
  if (!name.starts_with(package)) return (folder / name).string();
  const fs::path inside = name.substr(package.size());
  for (fs::path at = folder;; at = at.parent_path()) {
    if (fs::exists(at / inside)) return (at / inside).string();
    if (at.filename() == *inside.begin() && fs::exists(at.parent_path() / inside))
      return (at.parent_path() / inside).string();
    if (at == at.parent_path()) return "";
  }
}

}  // namespace

LiveAssets::LiveAssets(const RobotTexts& texts, const std::string& urdf_file)
    : urdf_(std::make_shared<const std::string>(texts.urdf)),
      urdf_uri_(std::string(package) + texts.name + "/" + texts.name + ".urdf") {
  const fs::path folder = fs::absolute(urdf_file).parent_path();
  constexpr std::string_view key = "filename=\"";
  for (std::size_t at = texts.urdf.find(key); at != std::string::npos; at = texts.urdf.find(key, at)) {
    at += key.size();
    const std::string name = texts.urdf.substr(at, texts.urdf.find('"', at) - at);
    files_[name] = place_of(name, folder);
  }
}

LiveAssets::Content LiveAssets::read(std::string_view uri) {
  if (uri == "robot.urdf" || uri == urdf_uri_) return urdf_;
  auto found = files_.find(uri);
  if (found == files_.end()) found = files_.find(std::string(package) + std::string(uri));
  if (found == files_.end() || !is_mesh(found->second)) return nullptr;
  std::weak_ptr<const std::string>& kept = read_[found->second];
  if (Content content = kept.lock()) return content;
  try {
    const auto content = std::make_shared<const std::string>(read_input_file(found->second, file_max_bytes));
    kept = content;
    return content;
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace kadans
