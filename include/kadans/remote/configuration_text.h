// The text of the robot's configuration as the instance read it, and the way back into the file: parameters that were
// tuned while it ran are written where they stand, everything else stays as it is. The file is there whole at any time,
// and nothing that somebody wrote meanwhile is lost: then nothing is written.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/remote/order.h"

namespace kadans {

class ConfigurationText {
 public:
  // Before the loop. Without a file nothing can be saved.
  explicit ConfigurationText(std::filesystem::path file);

  const std::filesystem::path& file() const noexcept { return file_; }
  // Threads that serve clients. Throws InputError when the file is no longer what was read, or a parameter has no place
  // in it; std::system_error when it cannot be written. Nothing is written then.
  void save(const std::vector<ParameterChange>& changes, const Catalog& catalog);

 private:
  std::filesystem::path file_;
  std::mutex mutex_;
  std::string text_;
};

}  // namespace kadans
