// Splits one process into many by fork(): each continues with a copy of the same memory. For a program with one thread.
#pragma once

#include <cstddef>
#include <vector>

#include "realtime/machine/child_process.h"

namespace kadans {

// Keeps the output of each new process. finish() prints it, in the order of the processes.
class ProcessSplit {
 public:
  // Returns true in the new process, where this object must not be used any more. At most `at_once` processes run at a
  // time. Throws std::system_error.
  bool split(std::size_t at_once);
  // In the first process: waits for all, prints their output, and returns the greatest of their exit codes.
  int finish();

 private:
  struct Child {
    ChildProcess process;
    MemoryFile said;
  };
  void wait_until_run(std::size_t most);
  std::vector<Child> children_;
};

}  // namespace kadans
