#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "commands.h"
#include "kadans/app/control_object_project.h"
#include "kadans/signal/input_error.h"
#include "terminal.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

void write_file(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw InputError({.file = file.string(), .message = "cannot be written"});
}

}  // namespace

int run_new_control_object(const NewControlObjectOptions& options) {
  ControlObjectNames names;
  try {
    names = control_object_names(options.name);
  } catch (const std::invalid_argument& error) {
    throw InputError({.message = "'" + options.name + "': " + error.what()});
  }
  const fs::path folder = fs::path(options.folder) / names.type;
  std::error_code error;
  if (fs::exists(folder, error)) {
    throw InputError({.file = folder.string(), .message = "is there already; nothing is overwritten"});
  }
  fs::create_directories(folder, error);
  if (error) throw InputError({.file = folder.string(), .message = "cannot be made: " + error.message()});
  for (const ProjectFile& file : control_object_project(names, options.plugin)) {
    write_file(folder / file.name, file.text);
    std::printf("%s\n", (folder / file.name).c_str());
  }
  std::fprintf(stderr, "Build and test it:  cd %s && cmake -B build && cmake --build build && build/%s_test\n",
               folder.c_str(), names.type.c_str());
  return exit_passed;
}

}  // namespace kadans
