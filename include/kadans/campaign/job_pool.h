// Runs programs in parallel, a bounded number at once. Each has a process of its own, so one that crashes or hangs does
// not disturb the others.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kadans {

struct Job {
  std::vector<std::string> arguments;  // the first is the program's path
  double wall_limit_s = 60;            // the process is killed after this time
};

struct JobOutcome {
  std::size_t job = 0;  // index
  int exit_code = -1;   // -1 when it was killed
  int signal = 0;       // the signal that killed it, else 0
  bool timed_out = false;
  bool cancelled = false;  // killed because stop_asked() was true
  double wall_s = 0;
  std::string out, err;
};

class JobWatcher {
 public:
  virtual ~JobWatcher() = default;
  virtual void ended(const JobOutcome& outcome) = 0;  // called in the order in which jobs end
  virtual void passed_time(std::size_t running) = 0;  // called a few times a second
  virtual bool stop_asked() const = 0;                // when true, no more jobs start and the running ones are killed
  virtual bool enough() const { return false; }       // when true, no more jobs start, and the running ones go on
};

// Runs `at_once` jobs at a time; 0: one for each core. Returns when all have ended. Uses only the calling thread.
// Throws std::system_error when a process cannot be started.
void run_jobs(std::span<const Job> jobs, std::size_t at_once, JobWatcher& watcher);

}  // namespace kadans
