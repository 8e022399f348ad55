// Which signals of a run its report shows, when nobody chose any.
#pragma once

#include "kadans/telemetry/signal_plot.h"
#include "report/run_page.h"

namespace kadans {

// Height, lean, feet, the joints that moved most beside what was commanded, shares of limits, errors; what the failed
// checks look at. Those that the record has. With the run's faults and pushes.
SignalPlot run_plot(const RecordOutline& record, const RunPage& page);

}  // namespace kadans
