// The page of one run (--report): text from its result, plots and pictures from its record.
#pragma once

#include <filesystem>
#include <string>

#include "kadans/scenario/html_report.h"
#include "report/report_options.h"

namespace kadans {

struct RunPage {
  const ReportSubject& subject;
  const ScenarioConfig& scenario;
  std::string name;    // of the run: scenario, and branch when there is one
  std::string record;  // file with its signals; "" when there is none
  std::vector<QuantityValue> quantities;
  std::vector<EvidenceTrace> evidence;
  std::vector<std::string> check_signals;  // of the checks that failed: shown in the plots as well
};

// Writes it into the folder, which is made. What cannot be drawn is left out, and the page says why. Throws InputError
// when the page cannot be written.
std::filesystem::path write_run_page(const RunPage& page, const ReportPlace& place);

}  // namespace kadans
