#include "kadans/realtime/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <system_error>

#include <fcntl.h>
#include <sched.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kadans {
namespace {

constexpr int tries_max = 100;
constexpr timespec between_tries{0, 100'000};

// A second descriptor of the same file, above those that the program will find.
class High {
 public:
  explicit High(int descriptor) : high_(fcntl(descriptor, F_DUPFD_CLOEXEC, child_memory_descriptor + 1)) {
    if (high_ < 0) throw std::system_error(errno, std::generic_category(), "no descriptor for a process");
  }
  ~High() { close(high_); }
  High(const High&) = delete;
  High& operator=(const High&) = delete;
  int get() const noexcept { return high_; }

 private:
  int high_;
};

// What posix_spawn is told, freed at the end.
class SpawnPlan {
 public:
  SpawnPlan(int bell, int memory) : bell_(bell), memory_(memory) {
    posix_spawn_file_actions_init(&files_);
    posix_spawn_file_actions_adddup2(&files_, bell_.get(), child_doorbell_descriptor);
    posix_spawn_file_actions_adddup2(&files_, memory_.get(), child_memory_descriptor);
    posix_spawn_file_actions_addclosefrom_np(&files_, child_memory_descriptor + 1);
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSCHEDULER);
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    sigemptyset(&signals);
    for (const int blocked : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP}) sigaddset(&signals, blocked);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    posix_spawnattr_setschedpolicy(&attributes_, SCHED_OTHER);
    const sched_param usual{};
    posix_spawnattr_setschedparam(&attributes_, &usual);
  }
  ~SpawnPlan() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&files_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  int spawn(pid_t& pid, const std::string& program, char* const* arguments) const {
    return posix_spawn(&pid, program.c_str(), &files_, &attributes_, arguments, environ);
  }

 private:
  High bell_, memory_;
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

ChildProcess::Started ChildProcess::start(const std::string& program, std::vector<std::string> arguments,
                                          const SharedMemory& memory) {
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  auto [ours, theirs] = Doorbell::make_pair();
  const SpawnPlan plan(theirs.descriptor(), memory.descriptor());
  pid_t pid = -1;
  const int error = plan.spawn(pid, program, words.data());
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start " + program);
  return {std::move(ours), pid};
}

ChildProcess::~ChildProcess() { (void)end(); }

bool ChildProcess::reap(int tries) noexcept {
  for (int i = 0; i < tries && !reaped_; ++i) {
    if (i > 0) nanosleep(&between_tries, nullptr);
    const pid_t ended = waitpid(pid_, &status_, WNOHANG);
    reaped_ = ended == pid_ || (ended < 0 && errno == ECHILD);  // as when somebody set SIGCHLD to be ignored
  }
  return reaped_;
}

void ChildProcess::kill() const noexcept {
  if (!reaped_) ::kill(pid_, SIGKILL);
}

std::string ChildProcess::end() noexcept {
  shutdown(bell_.descriptor(), SHUT_RDWR);
  if (!reap(tries_max / 4)) {
    kill();
    if (!reap(tries_max)) return "it does not even die";  // the system holds it; it has no hold on us
  }
  if (WIFEXITED(status_)) return "exit code " + std::to_string(WEXITSTATUS(status_));
  const int signal = WTERMSIG(status_);
  return "signal " + std::to_string(signal) + " (" + sigdescr_np(signal) + ")";
}

bool ChildProcess::exited(int code) const noexcept {
  return reaped_ && WIFEXITED(status_) && WEXITSTATUS(status_) == code;
}

void die_with_parent() noexcept { (void)prctl(PR_SET_PDEATHSIG, SIGKILL); }

}  // namespace kadans
