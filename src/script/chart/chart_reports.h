// Reports: events that tell what happened to a behavior. "error" when one of its functions raised (chart_recovery.cpp),
// "refused" when the control engine refused one of its transactions, "fault.NAME" when the safety layer noted a fault.
// Nobody can send them. Where no active state waits for them they are no events at all.
#pragma once

#include <string_view>
#include <vector>

#include "chart.h"

namespace kadans {

bool reserved_for_reports(std::string_view event) noexcept;

// Finds the reports that the chart's transitions wait for; faults that do not exist are mistakes, and so are final
// states whose outcome has such a name.
void find_reports(Chart& chart, std::vector<InputProblem>& problems);

}  // namespace kadans
