// A folder in the build folder for the files of one process of tests: several run at the same time.
#pragma once

#include <filesystem>
#include <string>

#include <unistd.h>

namespace kadans::football::test {

struct ProcessFolder {
  explicit ProcessFolder(const std::string& name)
      : path(KADANS_BINARY_DIR "/" + name + "-" + std::to_string(getpid())) {
    std::filesystem::create_directories(path);
  }
  ~ProcessFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  ProcessFolder(const ProcessFolder&) = delete;
  ProcessFolder& operator=(const ProcessFolder&) = delete;

  std::filesystem::path path;
};

}  // namespace kadans::football::test
