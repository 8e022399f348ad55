// Runs programs side by side, so many at once, each in a process of its own: one that crashes or hangs takes nothing
// else with it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kadans {

struct Job {
  std::vector<std::string> arguments;  // the first is the program's path
  double wall_limit_s = 60;            // then it is killed
};

struct JobOutcome {
  std::size_t job = 0;  // index
  int exit_code = -1;   // -1 when it was killed
  int signal = 0;       // that killed it
  bool timed_out = false;
  bool cancelled = false;  // because everything was to stop
  double wall_s = 0;
  std::string out, err;
};

class JobWatcher {
 public:
  virtual ~JobWatcher() = default;
  virtual void ended(const JobOutcome& outcome) = 0;  // in the order in which they end
  virtual void passed_time(std::size_t running) = 0;  // a few times a second
  virtual bool stop_asked() const = 0;                // no more are started, those that run are killed
};

// So many at once, 0: one for each core. Returns when all have ended. Throws std::system_error when a process cannot be started. One thread.
void run_jobs(std::span<const Job> jobs, std::size_t at_once, JobWatcher& watcher);

}  // namespace kadans
