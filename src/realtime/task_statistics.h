// How well a periodic task keeps its time. Written by the task alone, without locks; any thread may read while it runs:
// each number is whole, but not all are of the same beat.
//
//   lateness   wake-up after the time it was due
//   jitter     |interval - period| against the wake-up before: the definition of the timing test of 2008
//   execution  from the wake-up to the end of the work
#pragma once

#include <cstdint>

#include "engine/tick/tick_statistics.h"
#include "kadans/exchange/one_writer.h"

namespace kadans {

struct TaskStatistics {
  TickStatistics lateness, jitter, execution;
  Count overruns;    // the work was not done when the next beat was due
  Count late_wakes;  // the system woke the task a whole period late, or later
  Count missed;      // beats left out for either reason
};

}  // namespace kadans
