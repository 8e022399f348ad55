#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "record_meshes.h"
#include "remote/page/page_files.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

// `kadans view` shows a record in the web page.
struct ViewOptions {
  std::string record;
  LiveServiceOptions live;
};

std::string in_url(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const bool plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' || c == '-';
    constexpr const char* digits = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    safe += plain ? std::string(1, c) : std::string{'%', digits[byte >> 4U], digits[byte & 15U]};
  }
  return safe;
}

int run_view(const ViewOptions& options) {
  if (page_files().empty()) refuse(std::string(page_is_missing));
  const std::filesystem::path file = options.record.empty() ? "" : std::filesystem::absolute(options.record);
  if (!file.empty()) check_input_file(file);
  LiveServer server(
      {.address = options.live.address, .port = options.live.port_number(), .token = "", .hosts = options.live.hosts},
      nullptr,
      {.file = file.string(), .take_frame = {}, .read_mesh = file.empty() ? nullptr : meshes_of_record(file.string())});
  catch_interrupts();
  server.start();
  const std::string shown = file.empty() ? "empty" : "record=record.mcap&title=" + in_url(file.filename().string());
  std::printf("%s?%s\n", server.url().substr(0, server.url().find('?')).c_str(), shown.c_str());
  std::fflush(stdout);
  while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  return exit_passed;
}

}  // namespace

void add_view(CommandLine& line) {
  const auto [view, options] = line.add<ViewOptions>("view", "Show a record in the browser", run_view);
  view->add_option("record", options.record, "Record (MCAP); without it, drop one onto the page")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  options.live.port = "0";
  add_whole(*view, "--port", options.live.port, 0, 65535, "Port (default: a free one)");
  view->add_option("--live-address", options.live.address, "Address to listen on (default: this machine alone)")
      ->type_name("IP");
  add_live_hosts(*view, options.live);
}

}  // namespace kadans
