// Makes a machine busy, so that timing can be measured where it matters: processes that compute, fill memory, write to
// the disk, wake each other and set timers, of the usual scheduling class.
//
// Processes, not threads: they share neither the memory lock nor the fate of the one who measures; they end with it.
#pragma once

#include <vector>

#include "kadans/realtime/child_process.h"

namespace kadans {

class MachineLoad {
 public:
  // Before other threads are started. Throws std::system_error when there can be no process.
  MachineLoad();

 private:
  void start(void (*work)());

  std::vector<ChildProcess> processes_;
};

}  // namespace kadans
