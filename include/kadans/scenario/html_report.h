// A run as one page for people: what happened in words, plots, pictures, every check, transition, fault and line of the
// log, and the command that repeats it.
#pragma once

#include <string>
#include <vector>

#include "kadans/scenario/report.h"

namespace kadans {

struct ReportPicture {
  double time_s = 0;
  std::string png;
};

struct HtmlReport {
  const ReportSubject& subject;
  std::string scenario, doc, robot, program;  // program: "kadans 0.1.0"
  std::vector<QuantityValue> quantities;      // that were set or drawn
  std::vector<EvidenceTrace> evidence;        // of the checks that failed
  std::string plot;                           // SVG; "" when there is none ...
  std::string no_plot;                        // ... then why
  std::string plot_style;                     // its colors on dark paper
  std::vector<ReportPicture> film;
  std::string no_film;  // why there is none
};

std::string html_report(const HtmlReport& report);

// "squat-1.html": of the run of that name and seed.
std::string report_file(const std::string& name, std::uint64_t seed);

}  // namespace kadans
