#include "kadans/campaign/job_pool.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <memory>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kadans {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int poll_ms = 100;

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

// The reading end of a pipe whose other end a child writes to.
class Pipe {
 public:
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno, "pipe");
    read_ = ends[0];
    write_ = ends[1];
    (void)fcntl(read_, F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    close_writing();
    if (read_ >= 0) close(read_);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reading() const noexcept { return open_ ? read_ : -1; }
  int writing() const noexcept { return write_; }
  void close_writing() noexcept {
    if (write_ >= 0) close(write_);
    write_ = -1;
  }
  // Takes what is there; notes when the other end is closed.
  void drain(std::string& text) {
    std::array<char, 65536> block{};
    while (open_) {
      const ssize_t got = read(read_, block.data(), block.size());
      if (got > 0) {
        text.append(block.data(), static_cast<std::size_t>(got));
      } else if (got < 0 && errno == EINTR) {
        continue;
      } else {
        open_ = got < 0 && errno == EAGAIN;
        return;
      }
    }
  }
  bool open() const noexcept { return open_; }

 private:
  int read_ = -1, write_ = -1;
  bool open_ = true;
};

// One child process in a process group of its own.
class Child {
 public:
  Child(const Job& job, std::size_t index) : job_(job), began_(Clock::now()) {
    outcome_.job = index;
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out_.writing(), 1);
    posix_spawn_file_actions_adddup2(&actions, err_.writing(), 2);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<char*> arguments;
    for (const std::string& argument : job.arguments) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    const int error = posix_spawn(&pid_, arguments[0], &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) fail(error, job.arguments.front());
    out_.close_writing();
    err_.close_writing();
  }
  ~Child() {
    if (ended_) return;
    kill_all();
    waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void add_to(std::vector<pollfd>& waited) const {
    for (const Pipe* pipe : {&out_, &err_}) {
      if (pipe->open()) waited.push_back({pipe->reading(), POLLIN, 0});
    }
  }

  void cancel() {
    outcome_.cancelled = true;
    kill_all();
  }

  // Takes what it wrote, kills it when its time is over. True when it has ended.
  bool look() {
    out_.drain(outcome_.out);
    err_.drain(outcome_.err);
    outcome_.wall_s = std::chrono::duration<double>(Clock::now() - began_).count();
    if (!outcome_.timed_out && outcome_.wall_s > job_.wall_limit_s) {
      outcome_.timed_out = true;
      kill_all();
    }
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
    ended_ = true;
    out_.drain(outcome_.out);
    err_.drain(outcome_.err);
    if (WIFEXITED(status)) outcome_.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome_.signal = WTERMSIG(status);
    return true;
  }
  const JobOutcome& outcome() const noexcept { return outcome_; }

 private:
  void kill_all() const noexcept { kill(-pid_, SIGKILL); }

  const Job& job_;
  Clock::time_point began_;
  Pipe out_, err_;
  pid_t pid_ = -1;
  bool ended_ = false;
  JobOutcome outcome_;
};

}  // namespace

void run_jobs(std::span<const Job> jobs, std::size_t at_once, JobWatcher& watcher) {
  if (at_once == 0) at_once = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::unique_ptr<Child>> running;
  std::size_t next = 0;
  bool stopped = false;
  while (next < jobs.size() || !running.empty()) {
    if (watcher.stop_asked() && !stopped) {
      stopped = true;
      next = jobs.size();
      for (const auto& child : running) child->cancel();
    }
    for (; next < jobs.size() && running.size() < at_once; ++next) {
      running.push_back(std::make_unique<Child>(jobs[next], next));
    }
    std::vector<pollfd> waited;
    for (const auto& child : running) child->add_to(waited);
    // A child that closed its output and lives on is looked at in time.
    (void)poll(waited.data(), waited.size(), waited.size() < 2 * running.size() ? 1 : poll_ms);
    std::erase_if(running, [&](const std::unique_ptr<Child>& child) {
      if (!child->look()) return false;
      watcher.ended(child->outcome());
      return true;
    });
    watcher.passed_time(running.size());
  }
}

}  // namespace kadans
