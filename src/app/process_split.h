// Splits one process into many by fork(): each continues with a copy of the same memory. For a program with one thread.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace kadans {

// The output of each new process is kept, and printed in their order.
class ProcessSplit {
 public:
  ProcessSplit();
  ~ProcessSplit();
  ProcessSplit(const ProcessSplit&) = delete;
  ProcessSplit& operator=(const ProcessSplit&) = delete;

  // Returns true in the new process, where this object must not be used any more. At most `at_once` processes run at a
  // time. Throws std::system_error.
  bool split(std::size_t at_once);
  // In the first process: waits for all, prints their output, and returns the greatest of their exit codes.
  int finish();

 private:
  struct Child;
  void wait_for_one();
  std::vector<std::unique_ptr<Child>> children_;
};

}  // namespace kadans
