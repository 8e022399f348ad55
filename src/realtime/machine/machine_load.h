// Makes a machine busy, so that timing can be measured where it matters: starts processes of the normal scheduling
// class that compute, fill memory, write to the disk, wake each other and set timers.
//
// They are processes and not threads, so that they do not share the memory lock of the process that measures, and
// cannot make it fail. They end with it.
#pragma once

#include <vector>

#include "child_process.h"

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
