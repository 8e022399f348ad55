#include "record_pictures.h"

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "app/services.h"
#include "app/terminal.h"
#include "config/json/fields.h"
#include "realtime/machine/child_process.h"
#include "record_meshes.h"
#include "remote/page/page_files.h"
#include "signal/input_file.h"

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

// The path of the program: $KADANS_CHROMIUM, or found in PATH; "": there is none.
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

// A headless Chromium that loads a page. It has a process group and a folder of its own; both end with this object.
class Chromium {
 public:
  // Throws std::system_error when it cannot be started.
  Chromium(const std::string& program, const std::string& url, int width, int height) {
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
  ~Chromium() {
    process_->stop();  // it keeps nothing worth a farewell
    std::error_code ignored;
    for (int i = 0; i < 20 && !fs::remove_all(folder_, ignored) && ignored; ++i) usleep(50'000);  // its children end
  }
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  bool runs() noexcept { return !process_->ended(); }

 private:
  fs::path folder_;
  std::optional<ChildProcess> process_;  // while the object lives
};

// The limit for the first picture, while Chromium starts and loads a record of any size, and between two pictures.
constexpr std::chrono::seconds patience{120};
constexpr std::chrono::milliseconds look_for_pictures{200};

// Carries pictures from the server's thread to the waiting thread.
class Frames {
 public:
  void take(const std::string& name, const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    if (name == "done") {
      done_ = true;
    } else if (name == "failed") {
      problem_ = bytes;
    } else {
      waiting_.push_back({name, bytes});
    }
    came_.notify_one();
  }

  struct Frame {
    std::string name, bytes;
  };
  // The pictures that came; empty: all are done. Throws InputError when the page failed, when Chromium has ended, or
  // when nothing comes in time.
  std::vector<Frame> next(Chromium& chromium) {
    std::unique_lock lock(mutex_);
    const auto end = std::chrono::steady_clock::now() + patience;
    while (waiting_.empty() && !done_ && problem_.empty()) {
      if (came_.wait_for(lock, look_for_pictures) == std::cv_status::no_timeout) continue;
      if (interrupted()) refuse("interrupted");
      if (!chromium.runs()) refuse("chromium ended before the picture was drawn");
      if (std::chrono::steady_clock::now() > end) refuse("chromium draws nothing");
    }
    if (!problem_.empty()) refuse(problem_);
    return std::exchange(waiting_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Frame> waiting_;
  std::string problem_;
  bool done_ = false;
};

std::string address_of(const PictureOptions& options, const LiveServer& server) {
  const std::string url = server.url() + "&record=record.mcap&render=1&theme=" + options.theme +
                          "&width=" + std::to_string(options.width) + "&height=" + std::to_string(options.height);
  return url + (options.every_s ? "&every=" + number_text(*options.every_s) : "&at=" + number_text(options.at_s));
}

}  // namespace

std::string pictures_missing() {
  if (page_files().empty()) return std::string(page_is_missing);
  return find_chromium().empty() ? "pictures are drawn by Chromium: install the package chromium" : "";
}

void draw_record(const PictureOptions& options,
                 const std::function<void(const std::string& name, std::string bytes)>& take) {
  if (const std::string missing = pictures_missing(); !missing.empty()) refuse(missing);
  Frames frames;
  LiveServer server(
      {.port = 0, .token = "", .hosts = {}}, nullptr,
      {.file = std::filesystem::absolute(options.record).string(),
       .take_frame = [&frames](const std::string& name, const std::string& bytes) { frames.take(name, bytes); },
       .read_mesh = meshes_of_record(options.record)});
  server.start();
  Chromium chromium(find_chromium(), address_of(options, server), options.width, options.height);
  for (std::vector<Frames::Frame> got = frames.next(chromium); !got.empty(); got = frames.next(chromium)) {
    for (Frames::Frame& frame : got) take(frame.name, std::move(frame.bytes));
  }
}

}  // namespace kadans
