// Tells when somebody has saved a script. It uses inotify on folders, so it also sees editors that write a new file and
// rename it over the old one. It only says that something changed and is quiet again; the caller finds out what changed
// by comparing texts. One thread; never blocks.
#pragma once

#include <filesystem>
#include <set>

#include "signal/owned_descriptor.h"

namespace kadans {

class FileWatch {
 public:
  FileWatch();  // throws std::runtime_error when the system has no watches left

  // False: the folder cannot be watched. Adding a folder again is cheap.
  bool add(const std::filesystem::path& folder);

  // True once, when a Lua file was closed by its writer or moved into place and none has changed since the last call.
  bool poll() noexcept;

 private:
  bool drain() const noexcept;  // true when any event came

  OwnedDescriptor fd_;
  std::set<std::filesystem::path> folders_;
  bool pending_ = false;
};

}  // namespace kadans
