// --report: the folder for the pages of runs, and when they get pictures.
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct ReportOptions {
  std::string folder;  // "": no report
  std::string film;    // always, failed, never

  bool wanted() const noexcept { return !folder.empty(); }
};
void add_report_options(CLI::App& command, ReportOptions& place, const char* what, const char* film);

}  // namespace kadans
