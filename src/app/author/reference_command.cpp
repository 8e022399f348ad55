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

void add_reference(CLI::App& app, ReferenceOptions& options) {
  CLI::App* reference = app.add_subcommand("reference", "")->group("");
  reference->add_option("folder", options.folder)->required();
}

int run_reference(const CLI::App& app, const ReferenceOptions& options) {
  const fs::path folder(options.folder);
  for (const char* part : {"man", "completion", "pages"}) fs::create_directories(folder / part);
  write_durably(folder / "man/kadans.1", man_page(app, "kadans"));
  for (const CLI::App* command : visible_below(app)) {
    const std::string& name = command->get_name();
    write_durably(folder / "man" / ("kadans-" + name + ".1"), man_page(*command, "kadans " + name));
  }
  write_durably(folder / "completion/kadans", completion_script(app, "bash"));
  write_durably(folder / "completion/_kadans", completion_script(app, "zsh"));
  write_durably(folder / "pages/commands.md", command_reference(app));
  write_durably(folder / "pages/files.md", field_reference());
  write_durably(folder / "pages/control_objects.md", object_reference(project_root(fs::current_path() / "config")));
  return exit_passed;
}

}  // namespace kadans
