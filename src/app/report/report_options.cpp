#include "report_options.h"

#include <CLI/CLI.hpp>

namespace kadans {

void add_report_options(CLI::App& command, ReportOptions& place, const char* what, const char* film) {
  place.film = film;
  CLI::Option* folder = command.add_option("--report", place.folder, what)->type_name("FOLDER");
  command.add_option("--film", place.film, std::string("With --report: pictures of the robot (default: ") + film + ")")
      ->check(CLI::IsMember({"always", "failed", "never"}))
      ->needs(folder);
}

}  // namespace kadans
