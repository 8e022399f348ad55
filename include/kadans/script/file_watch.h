// Tells that somebody saved a script: inotify on folders, so that editors that write a new file and rename it over the
// old one are seen too. It says only that something changed and is quiet again; what changed is for the reader to find
// out, by comparing texts. One thread, never blocks.
#pragma once

#include <filesystem>
#include <set>

namespace kadans {

class FileWatch {
 public:
  FileWatch();  // throws std::runtime_error when the system has no watches left
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  // False: the folder cannot be watched. Asking again is cheap.
  bool add(const std::filesystem::path& folder);

  // True once after a Lua file was closed by its writer or moved into place and no other was since the last call.
  bool poll() noexcept;

 private:
  bool drain() const noexcept;  // whether anything came

  int fd_;
  std::set<std::filesystem::path> folders_;
  bool pending_ = false;
};

}  // namespace kadans
