#include "ctl_service.h"

#include <CLI/CLI.hpp>

#include "app/terminal.h"
#include "kadans/signal/input_error.h"

namespace kadans {

void add_ctl_service(CLI::App& command, CtlServiceOptions& place) {
  CLI::Option* folder =
      command
          .add_option("--ctl", place.folder, "Folder in which 'kadans ctl' finds this run (default: see docs/ctl.md)")
          ->type_name("FOLDER");
  command.add_flag("!--no-ctl", place.wanted, "Hide this run from 'kadans ctl'")->excludes(folder);
  command.add_option("--ctl-operators", place.operators, "Group that may operate this run")->type_name("GROUP");
  command
      .add_option("--ctl-developers", place.developers,
                  "Group that may also change parameters and behaviors of this run")
      ->type_name("GROUP");
}

CtlService::CtlService(const CtlServiceOptions& place, Instance& instance) {
  if (!place.wanted) return;
  const bool named = !place.folder.empty();
  try {
    sockets_.emplace(
        CtlSockets::Settings{.folder = named ? std::filesystem::path(place.folder) : ctl_folder_for_server(),
                             .operators = place.operators,
                             .developers = place.developers});
    server_.emplace(instance, *sockets_, CtlServer::Settings{});
  } catch (const InputError& error) {
    if (named) throw;
    print_error(std::string("kadans ctl will not find this run: ") + error.what());
  }
}

void CtlService::start() {
  if (server_) server_->start();
}

void CtlService::stop() noexcept {
  if (server_) server_->stop();
}

}  // namespace kadans
