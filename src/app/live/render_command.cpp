// The page draws in a headless Chromium and posts what it drew; this writes it.
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <vector>

#include <CLI/CLI.hpp>

#include "kadans/config/fields.h"
#include "kadans/remote/page_files.h"
#include "kadans/telemetry/animated_png.h"
#include "live/chromium.h"
#include "live/page_commands.h"
#include "terminal.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// Its process starts, draws in software and loads a record of any size meanwhile; between two pictures it takes no
// more.
constexpr std::chrono::seconds patience{120};
constexpr std::chrono::milliseconds look_again{200};

// From the server's thread to the one that waits.
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
  // What came; empty: all is done. Throws InputError when the page failed, Chromium is gone, or nothing comes.
  std::vector<Frame> next(Chromium& chromium) {
    std::unique_lock lock(mutex_);
    const auto end = std::chrono::steady_clock::now() + patience;
    while (waiting_.empty() && !done_ && problem_.empty()) {
      if (came_.wait_for(lock, look_again) == std::cv_status::no_timeout) continue;
      if (interrupted()) throw InputError({.message = "interrupted"});
      if (!chromium.runs()) throw InputError({.message = "chromium ended before the picture was drawn"});
      if (std::chrono::steady_clock::now() > end) throw InputError({.message = "chromium draws nothing"});
    }
    if (!problem_.empty()) throw InputError({.message = problem_});
    return std::exchange(waiting_, {});
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<Frame> waiting_;
  std::string problem_;
  bool done_ = false;
};

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  if (!out.flush()) throw InputError({.file = file.string(), .message = "cannot be written"});
  std::printf("%s\n", file.string().c_str());
}

struct Size {
  int width = 0, height = 0;
};

Size size_of(const std::string& text) {
  Size size;
  char rest = 0;
  const int got = std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest);  // NOLINT: checked
  if (got != 2 || size.width < 16 || size.height < 16 || size.width > 4096 || size.height > 4096)
    throw InputError(InputProblem{.file = "--size", .message = "must be like 960x720, from 16 to 4096"});
  return size;
}

std::string address_of(const RenderOptions& options, const LiveServer& server, Size size) {
  std::string url = server.url() + "&record=record.mcap&render=1&theme=" + options.theme +
                    "&width=" + std::to_string(size.width) + "&height=" + std::to_string(size.height);
  if (options.film) return url + "&every=" + number_text(1.0 / options.frames_per_s);
  if (options.every_s) return url + "&every=" + number_text(*options.every_s);
  return url + "&at=" + number_text(options.at_s.value_or(0));
}

}  // namespace

void add_render(CLI::App& app, RenderOptions& options) {
  CLI::App* render = app.add_subcommand("render", "Draw the robot of a record, as PNG or as a film");
  render->add_option("record", options.record, "Record (MCAP)")
      ->required()
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  CLI::Option* at = render->add_option("--at", options.at_s, "One picture, at this second")->type_name("S");
  CLI::Option* every = render->add_option("--every", options.every_s, "A picture each so many seconds")
                           ->type_name("S")
                           ->check(CLI::Range(0.001, 1e6))
                           ->excludes(at);
  render->add_flag("--film", options.film, "An animated PNG of all of it")->excludes(at)->excludes(every);
  render->add_option("--fps", options.frames_per_s, "Pictures a second of the film (20)")->check(CLI::Range(1, 60));
  render->add_option("-o,--out", options.out, "File, or with --every folder (default: named as the record, here)")
      ->type_name("PATH");
  render->add_option("--size", options.size, "Width and height (960x720)")->type_name("WxH");
  render->add_option("--theme", options.theme, "light (default) or dark")->check(CLI::IsMember({"light", "dark"}));
}

int run_render(const RenderOptions& options) {
  const Size size = size_of(options.size);
  if (page_files().empty()) throw InputError({.message = std::string(page_is_missing)});
  const std::string program = find_chromium();
  if (program.empty()) throw InputError({.message = "pictures are drawn by Chromium: install the package chromium"});
  Frames frames;
  LiveServer server(
      {.port = 0}, nullptr,
      {.file = fs::absolute(options.record).string(),
       .take_frame = [&frames](const std::string& name, const std::string& bytes) { frames.take(name, bytes); }});
  catch_interrupts();
  server.start();
  Chromium chromium(program, address_of(options, server, size), size.width, size.height);
  const std::string stem = fs::path(options.record).stem().string();
  const fs::path out = !options.out.empty() ? options.out : options.every_s ? stem : stem + ".png";
  if (options.every_s) fs::create_directories(out);
  std::vector<std::string> film;
  for (std::vector<Frames::Frame> got = frames.next(chromium); !got.empty(); got = frames.next(chromium)) {
    for (Frames::Frame& frame : got) {
      if (options.film) {
        film.push_back(std::move(frame.bytes));
      } else {
        write(options.every_s ? out / fs::path(frame.name).filename() : out, frame.bytes);
      }
    }
  }
  if (options.film) write(out, animated_png(film, options.frames_per_s));
  return exit_passed;
}

}  // namespace kadans
