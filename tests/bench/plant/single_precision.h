// Our plant once more, compiled for single precision against Bullet's single-precision libraries. Both have the same
// names, so it runs in a program of its own (single_precision_main.cpp), a turn each time it is asked.
#pragma once

#include <string>

#include <sys/types.h>

namespace kadans::bench {

struct SinglePrecision {
  double step_us = 0, drift_mm = 0;
  int contact_count = 0;
};

class SinglePrecisionRun {
 public:
  SinglePrecisionRun();  // TULip standing; throws std::runtime_error when the program cannot be started
  ~SinglePrecisionRun();
  SinglePrecisionRun(const SinglePrecisionRun&) = delete;
  SinglePrecisionRun& operator=(const SinglePrecisionRun&) = delete;

  void turn();
  SinglePrecision end();  // no more turns

 private:
  int socket_ = -1;
  pid_t child_ = 0;
};

}  // namespace kadans::bench
