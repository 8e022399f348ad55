#include "project_root.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <vector>

#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

bool is_root(const fs::path& folder) {
  std::error_code ignored;
  const std::array<const char*, 3> names{"config", "models", "behaviors"};
  return std::count_if(names.begin(), names.end(),
                       [&](const char* name) { return fs::is_directory(folder / name, ignored); }) >= 2;
}

std::optional<fs::path> root_above(fs::path folder) {
  for (;;) {
    if (is_root(folder)) return folder;
    const fs::path parent = folder.parent_path();
    if (parent == folder || parent.empty()) return std::nullopt;
    folder = parent;
  }
}

fs::path folder_of(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::absolute(file, error);
  return error ? fs::path(".") : whole.lexically_normal().parent_path();
}

// PREFIX/share/kadans for a program in PREFIX/bin.
std::optional<fs::path> installed_root() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path folder = program.parent_path().parent_path() / "share/kadans";
  return !error && is_root(folder) ? std::optional(folder) : std::nullopt;
}

// The file that stands where `wanted` was looked for and has nearly its name.
std::string nearest_file(const fs::path& wanted) {
  constexpr std::size_t files_max = 1000;
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator i(wanted.parent_path(), error), end; !error && i != end; i.increment(error)) {
    if (names.size() < files_max) names.push_back(i->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return did_you_mean(wanted.filename().string(), names);
}

fs::path resolve_existing(std::string_view path, TextPlace place, std::string_view what, Problems& problems,
                          bool or_folder) {
  if (path.find('\0') == std::string_view::npos) {
    fs::path file = resolve(path, problems.file());
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) || (or_folder && fs::is_directory(file, ignored))) return file;
    problems.add(place, std::string(what) + ": there is no file " + (or_folder ? "or folder " : "") + in_quotes(path) +
                            " in " + project_root(problems.file()).string() + nearest_file(file));
  } else {
    problems.add(place, std::string(what) + ": " + in_quotes(path) + " is no path");
  }
  return {};
}

}  // namespace

fs::path project_root(const fs::path& file) {
  fs::path own = folder_of(file);
  if (const auto root = root_above(own)) return *root;
  std::error_code error;
  const fs::path working = fs::current_path(error);
  if (!error) {
    if (const auto root = root_above(working)) return *root;
  }
  return installed_root().value_or(own);
}

bool lies_in_project_here(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::canonical(file, error), working = fs::canonical(fs::current_path(error), error);
  if (error) return false;
  const auto own = root_above(whole.parent_path()), here = root_above(working);
  return own && here && *own == *here;
}

fs::path resolve(std::string_view path, const fs::path& file) {
  const fs::path written(path);
  if (written.is_absolute()) return written.lexically_normal();
  const bool beside = path.starts_with("./") || path.starts_with("../");
  return ((beside ? folder_of(file) : project_root(file)) / written).lexically_normal();
}

fs::path resolve_file(std::string_view path, TextPlace place, std::string_view what, Problems& problems) {
  return resolve_existing(path, place, what, problems, false);
}

fs::path resolve_file_or_folder(std::string_view path, TextPlace place, std::string_view what, Problems& problems) {
  return resolve_existing(path, place, what, problems, true);
}

std::filesystem::path user_folder(const char* variable, const char* below_home) {
  const char* const named = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): no thread changes it
  const char* const home = std::getenv("HOME");     // NOLINT(concurrency-mt-unsafe)
  if (named != nullptr && *named == '/') return fs::path(named) / "kadans";
  return home != nullptr && *home == '/' ? fs::path(home) / below_home / "kadans" : fs::path();
}

}  // namespace kadans
