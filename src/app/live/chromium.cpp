#include "live/chromium.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX asks for it

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
  std::vector<std::string> texts = arguments(program, url, folder_, width, height);
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int stream : {0, 1, 2}) posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int failed = posix_spawn(&process_, program.c_str(), &files, &attributes, list.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (failed == 0) return;
  fs::remove_all(folder_);
  throw std::system_error(failed, std::generic_category(), program);
}

bool Chromium::runs() noexcept {
  if (process_ < 0) return false;
  if (waitpid(process_, nullptr, WNOHANG) == 0) return true;
  process_ = -1;
  return false;
}

Chromium::~Chromium() {
  if (runs()) {
    (void)kill(-process_, SIGKILL);  // it has nothing to save
    (void)waitpid(process_, nullptr, 0);
  }
  std::error_code ignored;
  for (int i = 0; i < 20 && !fs::remove_all(folder_, ignored) && ignored; ++i) usleep(50'000);  // its children end
}

}  // namespace kadans
