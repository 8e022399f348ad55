// Which files `kadans check` looks at.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

struct CheckedFile {
  std::filesystem::path file;
  bool found = false;  // in a folder: what it is none of ours there is passed over
};

// Files as they are named, all below a folder, and what a pattern chooses ("config/*/robot.json"), each once. In a
// folder .urdf, .json and .lua count, not what begins with a dot; of a whole project only its config, models and
// behaviors. `scripts_only`: .lua alone. Throws InputError for what is not there and for a folder that holds nothing.
std::vector<CheckedFile> files_to_check(const std::vector<std::string>& named, bool scripts_only);

}  // namespace kadans
