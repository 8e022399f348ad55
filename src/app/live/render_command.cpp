#include <cstdio>
#include <filesystem>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "record_pictures.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"
#include "telemetry/plot/animated_png.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string record;
  std::optional<double> at_s, every_s;
  bool film = false;
  int frames_per_s = 20;
  std::string out;  // file, or a folder with every_s; "": named as the record, in the working directory
  std::string theme = "light", size = "960x720";
};

void write_picture(const fs::path& file, const std::string& bytes) {
  write_durably(file, bytes);
  std::printf("%s\n", file.string().c_str());
}

PictureOptions picture_options(const RenderOptions& options) {
  PictureOptions picture{.record = options.record,
                         .at_s = options.at_s.value_or(0),
                         .every_s = options.film ? 1.0 / options.frames_per_s : options.every_s,
                         .theme = options.theme};
  char rest = 0;
  const int got =
      std::sscanf(options.size.c_str(), "%dx%d%c", &picture.width, &picture.height, &rest);  // NOLINT: checked
  const auto fits = [](int pixels) { return pixels >= 16 && pixels <= 4096; };
  if (got != 2 || !fits(picture.width) || !fits(picture.height))
    refuse("--size", "must be like 960x720, from 16 to 4096");
  return picture;
}

int run_render(const RenderOptions& options) {
  const PictureOptions picture = picture_options(options);
  if (const std::string missing = pictures_missing(); !missing.empty()) refuse(missing);
  catch_interrupts();
  const std::string stem = fs::path(options.record).stem().string();
  const fs::path out = !options.out.empty() ? options.out : options.every_s ? stem : stem + ".png";
  if (options.every_s) fs::create_directories(out);
  std::vector<std::string> film;
  draw_record(picture, [&](const std::string& name, std::string bytes) {
    if (options.film) {
      film.push_back(std::move(bytes));
    } else {
      write_picture(options.every_s ? out / fs::path(name).filename() : out, bytes);
    }
  });
  if (options.film) write_picture(out, animated_png(film, options.frames_per_s));
  return exit_passed;
}

}  // namespace

void add_render(CommandLine& line) {
  const auto [render, options] =
      line.add<RenderOptions>("render", "Draw the robot of a record, as PNG or as a film", run_render);
  render->add_option("record", options.record, "Record (MCAP)")
      ->required()
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  CLI::Option* at =
      render->add_option("--at", options.at_s, "Draw one picture, at this second")->type_name("S")->check(any_number());
  CLI::Option* every =
      add_number(*render, "--every", options.every_s, 0.001, 1e6, "S", "Draw a picture every S seconds")->excludes(at);
  render->add_flag("--film", options.film, "Draw the whole record as an animated PNG")->excludes(at)->excludes(every);
  add_whole(*render, "--fps", options.frames_per_s, 1, 60, "Pictures in a second of the film (default: 20)");
  render->add_option("-o,--out", options.out, "File, or with --every folder (default: named as the record, here)")
      ->type_name("PATH");
  render->add_option("--size", options.size, "Width and height (default: 960x720)")->type_name("WxH");
  render->add_option("--theme", options.theme, "light (default) or dark")->check(CLI::IsMember({"light", "dark"}));
}

}  // namespace kadans
