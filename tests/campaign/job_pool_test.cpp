// Programs side by side: what they leave, how they end, and that one that breaks down takes nothing with it.
#include "kadans/campaign/job_pool.h"

#include <csignal>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

Job shell(const std::string& command, double wall_limit_s = 60) { return {{"/bin/sh", "-c", command}, wall_limit_s}; }

class Watcher final : public JobWatcher {
 public:
  void ended(const JobOutcome& outcome) override {
    outcomes.at(outcome.job) = outcome;
    ++count;
  }
  void passed_time(std::size_t running) override { most_running = std::max(most_running, running); }
  bool stop_asked() const override { return count >= stop_after; }

  std::vector<JobOutcome> outcomes = std::vector<JobOutcome>(8);
  std::size_t count = 0, most_running = 0;
  bool enough() const override { return count >= enough_after; }
  std::size_t stop_after = 1000, enough_after = 1000;
};

}  // namespace

TEST_CASE("Each job's output, errors and exit code come back, crashes and hangs as such") {
  const std::vector<Job> jobs{shell("echo out; echo err >&2; exit 3"), shell("kill -SEGV $$"),
                              shell("while :; do :; done", 0.2), shell("head -c 300000 /dev/zero | tr '\\0' x")};
  Watcher watcher;
  run_jobs(jobs, 4, watcher);
  CHECK(watcher.count == 4);
  CHECK(watcher.outcomes[0].out == "out\n");
  CHECK(watcher.outcomes[0].err == "err\n");
  CHECK(watcher.outcomes[0].exit_code == 3);
  CHECK(watcher.outcomes[1].signal == SIGSEGV);
  CHECK(watcher.outcomes[2].timed_out);
  CHECK(watcher.outcomes[3].out.size() == 300000);
}

TEST_CASE("No more run at once than asked for") {
  const std::vector<Job> jobs(6, shell("true"));
  Watcher watcher;
  run_jobs(jobs, 2, watcher);
  CHECK(watcher.count == 6);
  CHECK(watcher.most_running <= 2);
}

TEST_CASE("A stop ends those that run and starts no more") {
  const std::vector<Job> jobs{shell("true"), shell("while :; do :; done"), shell("true")};
  Watcher watcher;
  watcher.stop_after = 1;
  run_jobs(jobs, 2, watcher);
  CHECK(watcher.outcomes[1].cancelled);
  CHECK(watcher.count == 2);
}

TEST_CASE("When it is enough, no more start, and those that run end by themselves") {
  const std::vector<Job> jobs{shell("true"), shell("head -c 1000000 /dev/zero | cksum >/dev/null; echo done"),
                              shell("true"), shell("true")};
  Watcher watcher;
  watcher.enough_after = 1;
  run_jobs(jobs, 2, watcher);
  CHECK(watcher.count == 2);
  CHECK_FALSE(watcher.outcomes[1].cancelled);
  CHECK(watcher.outcomes[1].out == "done\n");
}

TEST_CASE("A program that is not there is an error") {
  const std::vector<Job> jobs{{{"/no/such/program"}, 1}};
  Watcher watcher;
  CHECK_THROWS(run_jobs(jobs, 1, watcher));
}
