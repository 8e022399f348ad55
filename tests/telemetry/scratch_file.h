// A file name of its own for one test; what stands there is removed at the end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include <unistd.h>

namespace kadans {

class ScratchFile {
 public:
  ScratchFile() {
    static int count = 0;
    path_ = (std::filesystem::temp_directory_path() /
             ("kadans_" + std::to_string(::getpid()) + "_" + std::to_string(++count) + ".mcap"))
                .string();
  }
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string& path() const noexcept { return path_; }

  std::vector<std::byte> bytes() const {
    std::ifstream file(path_, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const auto all = std::as_bytes(std::span(text));
    return {all.begin(), all.end()};
  }
  void write(std::span<const std::byte> bytes) const {
    std::ofstream file(path_, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  std::string path_;
};

}  // namespace kadans
