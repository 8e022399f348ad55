// The page of one run (--report): its text comes from the result, plots and pictures from the record.
#pragma once

#include <filesystem>
#include <string>

#include "app/record_options.h"
#include "scenario/report/html_report.h"
#include "telemetry/plot/signal_plot.h"

namespace kadans {

struct RunPage {
  const RunReport& run;
  const ScenarioConfig& scenario;
  std::string robot;                       // its name, unless the record has another
  std::string name;                        // name of the run: scenario, and branch when there is one
  std::string record;                      // file with its signals; "" when there is none
  std::vector<std::string> check_signals;  // signals of the failed checks, which the plots show, too
};

// Writes the page into the folder, which it makes if need be. Plots or pictures that cannot be drawn are left out, and
// the page says why. Throws InputError when the page cannot be written.
std::filesystem::path write_run_page(const RunPage& page, const ReportOptions& place);

// Chooses the signals of a run that its report shows.
// Plots height, lean, feet, the joints that moved most together with their set-points, shares of limits, errors, and
// the signals of failed checks, as far as the record has them. The run's faults and pushes are marked.
SignalPlot run_plot(const RecordOutline& record, const RunPage& page);

}  // namespace kadans
