#include "checked_files.h"

#include <algorithm>
#include <set>

#include <glob.h>

#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

bool hidden(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') || name == "node_modules";
}

bool counts(const fs::path& file, bool scripts_only) {
  const std::string extension = file.extension().string();
  if (extension == ".lua") return true;
  if (scripts_only) return false;
  const std::string name = file.filename().string();
  if (name.ends_with(".schema.json") || name.ends_with(".golden.json")) return false;
  return extension == ".urdf" || extension == ".json";
}

void add_below(const fs::path& folder, bool scripts_only, std::vector<fs::path>& files) {
  for (fs::recursive_directory_iterator at(folder), end; at != end; ++at) {
    if (hidden(at->path())) {
      at.disable_recursion_pending();
    } else if (at->is_regular_file() && counts(at->path(), scripts_only)) {
      files.push_back(at->path());
    }
  }
}

// In a project only its three folders are searched, because it holds much else.
std::vector<fs::path> files_in(const fs::path& folder, bool scripts_only) {
  std::vector<fs::path> parts;
  for (const char* part : {"behaviors", "config", "models"}) {
    if (fs::is_directory(folder / part)) parts.push_back(folder / part);
  }
  if (parts.size() < 2) parts = {folder};
  std::vector<fs::path> files;
  for (const fs::path& part : parts) add_below(part, scripts_only, files);
  std::ranges::sort(files);
  if (files.empty())
    throw InputError({.file = folder.string(),
                      .message = scripts_only ? "there is no .lua in it" : "there is no .urdf, .json or .lua in it"});
  return files;
}

std::vector<fs::path> chosen_by(const std::string& pattern) {
  glob_t found{};
  std::vector<fs::path> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  }
  globfree(&found);
  if (paths.empty()) throw InputError({.file = pattern, .message = "nothing has a name like that"});
  return paths;
}

}  // namespace

std::vector<CheckedFile> files_to_check(const std::vector<std::string>& named, bool scripts_only) {
  std::vector<CheckedFile> all;
  std::set<fs::path> known;
  const auto add = [&](const fs::path& file, bool found) {
    if (known.insert(fs::absolute(file).lexically_normal()).second) all.push_back({file, found});
  };
  for (const std::string& name : named) {
    const bool pattern = !fs::exists(name) && name.find_first_of("*?[") != std::string::npos;
    for (const fs::path& path : pattern ? chosen_by(name) : std::vector<fs::path>{name}) {
      if (!fs::is_directory(path)) {
        add(path, false);
        continue;
      }
      for (const fs::path& file : files_in(path, scripts_only)) add(file, true);
    }
  }
  return all;
}

}  // namespace kadans
