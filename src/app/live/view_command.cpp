#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include <CLI/CLI.hpp>

#include "kadans/remote/page_files.h"
#include "live/page_commands.h"
#include "terminal.h"

namespace kadans {

void add_view(CLI::App& app, ViewOptions& options) {
  CLI::App* view = app.add_subcommand("view", "Show a record in the browser");
  view->add_option("record", options.record, "Record (MCAP)")->required()->type_name("FILE")->check(CLI::ExistingFile);
  options.live.port = "0";
  view->add_option("--port", options.live.port, "Port (default: one that is free)")->check(CLI::Range(0, 65535));
  view->add_option("--live-address", options.live.address, "Address to listen on (default: this machine alone)")
      ->type_name("IP");
}

int run_view(const ViewOptions& options) {
  if (page_files().empty()) throw InputError({.message = std::string(page_is_missing)});
  const std::string file = std::filesystem::absolute(options.record).string();
  LiveServer server({.address = options.live.address, .port = options.live.port_number()}, nullptr,
                    {.file = file, .take_frame = {}});
  catch_interrupts();
  server.start();
  std::printf("%s&record=record.mcap\n", server.url().c_str());
  std::fflush(stdout);
  while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  return exit_passed;
}

}  // namespace kadans
