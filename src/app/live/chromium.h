// A headless Chromium that loads a page. It has a process group and a folder of its own; both end with this object.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "realtime/machine/child_process.h"

namespace kadans {

// The path of the program: $KADANS_CHROMIUM, or found in PATH; "": there is none.
std::string find_chromium();

class Chromium {
 public:
  // Throws std::system_error when it cannot be started.
  Chromium(const std::string& program, const std::string& url, int width, int height);
  ~Chromium();
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  bool runs() noexcept { return !process_->ended(); }

 private:
  std::filesystem::path folder_;
  std::optional<ChildProcess> process_;  // while the object lives
};

}  // namespace kadans
