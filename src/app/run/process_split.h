// Splits one process into many by fork(): each continues with a copy of the same memory. For a program with one thread.
#pragma once

#include <cstddef>
#include <vector>

#include "realtime/machine/child_process.h"

namespace kadans {

// The output of each new process is kept, and printed in their order.
class ProcessSplit {
 public:
  // In the new process: true, and this object is of no more use there. Throws std::system_error.
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
