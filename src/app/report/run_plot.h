// Chooses the signals of a run that its report shows.
#pragma once

#include "run_page.h"
#include "telemetry/plot/signal_plot.h"

namespace kadans {

// Plots height, lean, feet, the joints that moved most together with their set-points, shares of limits, errors, and
// the signals of failed checks, as far as the record has them. The run's faults and pushes are marked.
SignalPlot run_plot(const RecordOutline& record, const RunPage& page);

}  // namespace kadans
