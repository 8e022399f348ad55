#include "chromium.h"

#include <cerrno>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace kadans {
namespace {

namespace fs = std::filesystem;

// Chromium's options: it draws WebGL in software and makes no other connections.
std::vector<std::string> arguments(const std::string& program, const std::string& url, const fs::path& folder,
                                   int width, int height) {
  std::vector<std::string> list{program,
                                "--headless",
                                "--use-angle=swiftshader",
                                "--enable-unsafe-swiftshader",
                                "--disable-background-networking",
                                "--disable-component-update",
                                "--disable-sync",
                                "--no-first-run",
                                "--hide-scrollbars",
                                "--disable-dev-shm-usage",
                                "--remote-debugging-port=0",  // without it, Chromium would exit when the page is loaded
                                "--user-data-dir=" + folder.string(),
                                "--window-size=" + std::to_string(width) + "," + std::to_string(height)};
  if (geteuid() == 0) list.emplace_back("--no-sandbox");  // otherwise it refuses to run as root
  list.push_back(url);
  return list;
}

}  // namespace

std::string find_chromium() {
  if (const char* named = std::getenv("KADANS_CHROMIUM"); named != nullptr) return named;  // NOLINT: no thread yet
  const char* path = std::getenv("PATH");                                                  // NOLINT: no thread yet
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      const std::string program = (fs::path(folder) / name).string();
      if (access(program.c_str(), X_OK) == 0) return program;
    }
  }
  return "";
}

Chromium::Chromium(const std::string& program, const std::string& url, int width, int height) {
  std::string pattern = (fs::temp_directory_path() / "kadans-page-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::system_error(errno, std::generic_category(), pattern);
  folder_ = pattern;
  try {
    process_.emplace(ProgramStart{.words = arguments(program, url, folder_, width, height),
                                  .files = {no_file, no_file, no_file},
                                  .own_group = true});
  } catch (...) {
    fs::remove_all(folder_);
    throw;
  }
}

Chromium::~Chromium() {
  process_->stop();  // it keeps nothing worth a farewell
  std::error_code ignored;
  for (int i = 0; i < 20 && !fs::remove_all(folder_, ignored) && ignored; ++i) usleep(50'000);  // its children end
}

}  // namespace kadans
