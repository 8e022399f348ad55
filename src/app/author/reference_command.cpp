// `kadans reference`, hidden: a build calls it for what is installed beside the program and for the manual's reference.
#include <cstdio>
#include <filesystem>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/terminal.h"
#include "config/robot/project_root.h"
#include "reference_pages.h"
#include "signal/durable_file.h"

namespace kadans {

namespace fs = std::filesystem;

namespace {

// The hidden command by which a build writes what is made from the program's own tables: man pages, completion, editor
// stubs and the pages of reference of the manual.
struct ReferenceOptions {
  std::string folder;
};

int run_reference(const CommandLine& line, const ReferenceOptions& options) {
  const fs::path folder(options.folder);
  for (const char* part : {"man", "completion", "pages"}) fs::create_directories(folder / part);
  write_durably(folder / "man/kadans.1", man_page(line.app, "kadans"));
  for (const CLI::App* command : visible_below(line.app)) {
    const std::string& name = command->get_name();
    write_durably(folder / "man" / ("kadans-" + name + ".1"), man_page(*command, "kadans " + name));
  }
  write_durably(folder / "completion/kadans", completion_script(line.app, "bash"));
  write_durably(folder / "completion/_kadans", completion_script(line.app, "zsh"));
  write_durably(folder / "pages/commands.md", command_reference(line.app));
  write_durably(folder / "pages/files.md", field_reference());
  write_durably(folder / "pages/control_objects.md", object_reference(project_root(fs::current_path() / "config")));
  return exit_passed;
}

}  // namespace

void add_reference(CommandLine& line) {
  const auto [reference, options] = line.add<ReferenceOptions>("reference", "", run_reference);
  reference->group("");
  reference->add_option("folder", options.folder)->required();
}

}  // namespace kadans
