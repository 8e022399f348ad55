#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/terminal.h"
#include "campaign/work/durable_file.h"
#include "control_object_project.h"
#include "kadans/signal/input_error.h"
#include "signal/shell_word.h"

namespace kadans {

namespace fs = std::filesystem;

void add_new(CLI::App& app, NewControlObjectOptions& options) {
  CLI::App* made = app.add_subcommand("new", "Write the first version of a new part of your project");
  made->require_subcommand(1);
  CLI::App* object = made->add_subcommand("control-object", "Write a control object: source, test and build files");
  object->add_option("name", options.name, "Name of its type, for example knee_damper")->required()->type_name("NAME");
  object->add_option("--in", options.folder, "Folder in which its folder is created (default: this one)")
      ->type_name("FOLDER");
  object->add_flag("--plugin", options.plugin, "Write a plug-in instead of a program");
}

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
    write_durably(folder / file.name, file.text);
    std::printf("%s\n", (folder / file.name).c_str());
  }
  std::fprintf(stderr, "Build and test it:  cd %s && cmake -B build && cmake --build build && build/%s_test\n",
               shell_word(folder.string()).c_str(), names.type.c_str());
  return exit_passed;
}

}  // namespace kadans
