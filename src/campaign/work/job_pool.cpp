#include "kadans/campaign/job_pool.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "realtime/machine/child_process.h"

namespace kadans {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int look_ms = 100;

// In a process group of its own.
class RunningJob {
 public:
  RunningJob(const Job& job, std::size_t index)
      : job_(job),
        process_(
            {.words = job.arguments, .files = {no_file, out_.descriptor(), err_.descriptor()}, .own_group = true}) {
    outcome_.job = index;
  }

  void cancel() {
    outcome_.cancelled = true;
    process_.kill();
  }

  // Kills it when its time is over. True when it has ended.
  bool look() {
    outcome_.wall_s = std::chrono::duration<double>(Clock::now() - began_).count();
    if (process_.ended()) {
      outcome_.exit_code = process_.exit_code();
      outcome_.signal = process_.signal();
      outcome_.out = out_.text();
      outcome_.err = err_.text();
      return true;
    }
    if (!outcome_.timed_out && outcome_.wall_s > job_.wall_limit_s) {
      outcome_.timed_out = true;
      process_.kill();
    }
    return false;
  }
  const JobOutcome& outcome() const noexcept { return outcome_; }
  const ChildProcess& process() const noexcept { return process_; }

 private:
  const Job& job_;
  Clock::time_point began_ = Clock::now();
  MemoryFile out_, err_;
  ChildProcess process_;
  JobOutcome outcome_;
};

}  // namespace

void run_jobs(std::span<const Job> jobs, std::size_t at_once, JobWatcher& watcher) {
  if (at_once == 0) at_once = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::unique_ptr<RunningJob>> running;
  std::size_t next = 0;
  bool stopped = false;
  while (next < jobs.size() || !running.empty()) {
    if (watcher.stop_asked() && !stopped) {
      stopped = true;
      next = jobs.size();
      for (const auto& job : running) job->cancel();
    }
    if (watcher.enough()) next = jobs.size();
    for (; next < jobs.size() && running.size() < at_once; ++next) {
      running.push_back(std::make_unique<RunningJob>(jobs[next], next));
    }
    std::vector<const ChildProcess*> processes;
    for (const auto& job : running) processes.push_back(&job->process());
    ChildProcess::wait_for_one(processes, look_ms);
    std::erase_if(running, [&](const std::unique_ptr<RunningJob>& job) {
      if (!job->look()) return false;
      watcher.ended(job->outcome());
      return true;
    });
    watcher.passed_time(running.size());
  }
}

}  // namespace kadans
