// Chooses the files that `kadans check` checks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

struct CheckedFile {
  std::filesystem::path file;
  bool found = false;  // found in a folder: a file there that is not ours is passed over
};

// The named files, all files below a named folder, and all files that a pattern chooses ("config/*/robot.json"), each
// once. In a folder .urdf, .json and .lua files count, but not names that begin with a dot. In a whole project only
// config, models and behaviors are searched. `scripts_only`: only .lua files. Throws InputError for a file that does
// not exist and for a folder without files to check.
std::vector<CheckedFile> files_to_check(const std::vector<std::string>& named, bool scripts_only);

}  // namespace kadans
