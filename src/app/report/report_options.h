// --report: the folder for the pages of runs, and when they get pictures.
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct ReportPlace {
  std::string folder;  // "": no report
  std::string film;    // always, failed, never

  bool wanted() const noexcept { return !folder.empty(); }
};
void add_report_place(CLI::App& command, ReportPlace& place, const char* what, const char* film);

}  // namespace kadans
