// Reports as HTML pages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report.h"
#include "signal/utf8.h"

namespace kadans {

std::string base64(std::string_view bytes);
// A whole document that holds its styles and pictures, makes no requests, and follows the reader's light or dark
// setting. `style` is CSS that is added after the style of all pages.
std::string html_page(const std::string& title, const std::string& body, const std::string& style = {});

// The report of a run as one HTML page: what happened in words, plots and pictures, every check, transition, fault and
// log line, and the command that repeats the run.
struct ReportPicture {
  double time_s = 0;
  std::string png;
};

struct HtmlReport {
  const RunReport& run;
  std::string scenario, doc, robot, program;  // program: "kadans 0.2.0"
  std::string plot{};                         // an SVG; "" when there is none ...
  std::string no_plot{};                      // ... and then the reason
  std::string plot_style{};                   // CSS with the plot's colors on a dark page
  std::vector<ReportPicture> film{};
  std::string no_film{};  // the reason why there is no film
};

std::string html_report(const HtmlReport& report);

// The name of a run's report file: "squat-1.html" for scenario "squat" and seed 1.
std::string report_file(const std::string& name, std::uint64_t seed);

}  // namespace kadans
