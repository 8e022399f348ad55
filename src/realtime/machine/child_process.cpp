#include "child_process.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kadans {
namespace {

constexpr int tries_max = 100;
constexpr timespec between_tries{0, 100'000};

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

// A signal that this process handles may interrupt the call; then it is made again.
template <typename Call>
auto uninterrupted(Call call) noexcept {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

// What posix_spawn is told, freed at the end.
class SpawnPlan {
 public:
  explicit SpawnPlan(const ProgramStart& start) : SpawnPlan() {
    plan_files(start.files);
    plan_signals(start.blocks_group_signals);
    short flags = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF;
    if (start.own_group) flags |= POSIX_SPAWN_SETPGROUP;
    const int policy = sched_getscheduler(0);
    if (policy == SCHED_FIFO || policy == SCHED_RR) flags |= POSIX_SPAWN_SETSCHEDULER;
    const sched_param usual{};
    posix_spawnattr_setschedpolicy(&attributes_, SCHED_OTHER);
    posix_spawnattr_setschedparam(&attributes_, &usual);
    posix_spawnattr_setflags(&attributes_, flags);
  }
  ~SpawnPlan() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&files_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  pid_t spawn(const ProgramStart& start) const {
    hear_of_ends();
    std::vector<char*> words;
    for (const std::string& word : start.words) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    const std::string& program = start.program.empty() ? start.words.front() : start.program;
    pid_t pid = -1;
    const int error = posix_spawnp(&pid, program.c_str(), &files_, &attributes_, words.data(), environ);
    if (error != 0) fail(error, "cannot start " + program);
    return pid;
  }

 private:
  // Whoever started this process may have left it with SIGCHLD ignored. Then the system takes a process off its list at
  // once, and the number of its group is lost with it.
  static void hear_of_ends() noexcept {
    struct sigaction now {};
    if (sigaction(SIGCHLD, nullptr, &now) != 0 || (now.sa_flags & SA_SIGINFO) != 0 || now.sa_handler != SIG_IGN) return;
    now.sa_handler = SIG_DFL;
    (void)sigaction(SIGCHLD, &now, nullptr);
  }

  SpawnPlan() {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
  }

  void plan_files(const std::vector<int>& files) {
    const int count = static_cast<int>(files.size());
    for (int i = 0; i < count; ++i) {
      const int file = files[static_cast<std::size_t>(i)];
      if (file == no_file) posix_spawn_file_actions_addopen(&files_, i, "/dev/null", O_RDWR, 0);
      if (file == no_file || (file == i && i <= STDERR_FILENO)) continue;
      high_.emplace_back(fcntl(file, F_DUPFD_CLOEXEC, count));  // above all that the program will find
      if (!high_.back()) fail(errno, "no descriptor for a process");
      posix_spawn_file_actions_adddup2(&files_, high_.back().number(), i);
    }
    posix_spawn_file_actions_addclosefrom_np(&files_, count);
  }

  void plan_signals(bool block_group_signals) {
    sigset_t signals;
    sigfillset(&signals);
    sigdelset(&signals, SIGHUP);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    sigemptyset(&signals);
    if (block_group_signals) {
      for (const int blocked : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP}) sigaddset(&signals, blocked);
    }
    posix_spawnattr_setsigmask(&attributes_, &signals);
  }

  std::vector<OwnedDescriptor> high_;
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

ChildProcess::ChildProcess(pid_t pid, bool own_group) noexcept
    // The C library declares pidfd_open without extern "C".
    : pid_(pid), owner_(getpid()), own_group_(own_group), end_(static_cast<int>(syscall(SYS_pidfd_open, pid, 0))) {}

ChildProcess::ChildProcess(const ProgramStart& start) : ChildProcess(SpawnPlan(start).spawn(start), start.own_group) {}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(other.pid_),
      owner_(other.owner_),
      own_group_(other.own_group_),
      running_(std::exchange(other.running_, false)),
      end_(std::move(other.end_)),
      status_(other.status_) {}

std::optional<ChildProcess> ChildProcess::copy() {
  const pid_t pid = fork();
  if (pid < 0) fail(errno, "fork");
  if (pid == 0) return std::nullopt;
  return ChildProcess(pid, false);
}

pid_t ChildProcess::copy_alone() noexcept { return fork(); }

void ChildProcess::wait_for_one(std::span<const ChildProcess* const> running, int most_ms) {
  std::vector<pollfd> ends;
  for (const ChildProcess* process : running) {
    ends.push_back({process->end_.number(), POLLIN, 0});
    if (!process->end_) most_ms = 1;
  }
  (void)poll(ends.data(), ends.size(), most_ms);
}

void ChildProcess::forget() noexcept {
  running_ = false;
  end_ = {};
}

bool ChildProcess::reap(bool waits) noexcept {
  if (!running_) return true;
  // Whoever it has started ends with it: its number is the group's until it is taken off the system's list.
  const int moment = waits ? 0 : WNOHANG;
  siginfo_t end{};
  const auto look = [&] { return waitid(P_PID, static_cast<id_t>(pid_), &end, WEXITED | WNOWAIT | moment); };
  if (own_group_ && uninterrupted(look) == 0) {
    if (end.si_pid != pid_) return false;  // it may end before the next call, which would take it off the list
    kill();
  }
  int status = 0;
  const pid_t got = uninterrupted([&] { return waitpid(pid_, &status, moment); });
  if (got == pid_) status_ = status;
  if (got == pid_ || (got < 0 && errno == ECHILD)) forget();  // as when somebody has ignored SIGCHLD since the start
  return !running_;
}

bool ChildProcess::ends_soon(int tries) noexcept {
  for (; tries > 0 && !ended(); --tries) nanosleep(&between_tries, nullptr);
  return ended();
}

void ChildProcess::wait() noexcept {
  while (!reap(true)) {
  }
}

void ChildProcess::kill() const noexcept {
  if (running_) ::kill(own_group_ ? -pid_ : pid_, SIGKILL);
}

void ChildProcess::stop() noexcept {
  if (owner_ != getpid()) return forget();
  if (ended()) return;
  kill();
  wait();
}

std::string ChildProcess::end() noexcept {
  if (!ends_soon(tries_max / 4)) {
    kill();
    if (!ends_soon(tries_max)) return forget(), "it does not even die";  // the system holds it; it has no hold on us
  }
  if (signal() != 0) {
    const char* const meaning = sigdescr_np(signal());  // none of real-time signals
    return "signal " + std::to_string(signal()) + (meaning == nullptr ? "" : std::string(" (") + meaning + ")");
  }
  return "exit code " + std::to_string(exit_code());
}

int ChildProcess::exit_code() const noexcept { return status_ && WIFEXITED(*status_) ? WEXITSTATUS(*status_) : -1; }

int ChildProcess::signal() const noexcept { return status_ && WIFSIGNALED(*status_) ? WTERMSIG(*status_) : 0; }

void die_with_parent() noexcept { (void)prctl(PR_SET_PDEATHSIG, SIGKILL); }

MemoryFile::MemoryFile(std::string_view text) : descriptor_(memfd_create("kadans-text", MFD_CLOEXEC)) {
  if (!descriptor_) fail(errno, "no file in memory");
  while (!text.empty()) {
    const ssize_t written = uninterrupted([&] { return write(descriptor(), text.data(), text.size()); });
    if (written <= 0) fail(errno, "a file in memory");
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  (void)lseek(descriptor(), 0, SEEK_SET);
}

std::string MemoryFile::text() const {
  struct stat file = {};
  if (fstat(descriptor(), &file) != 0) return {};
  std::string text(static_cast<std::size_t>(file.st_size), '\0');
  std::size_t got = 0;
  for (ssize_t more = 1; more > 0; got += static_cast<std::size_t>(std::max<ssize_t>(more, 0)))
    more = uninterrupted(
        [&] { return pread(descriptor(), text.data() + got, text.size() - got, static_cast<off_t>(got)); });
  text.resize(got);
  return text;
}

ProgramOutput run_program(std::vector<std::string> words, std::string_view input) {
  const MemoryFile in(input), out, err;
  ChildProcess process({.words = std::move(words), .files = {in.descriptor(), out.descriptor(), err.descriptor()}});
  process.wait();
  return {.exit_code = process.exit_code(), .out = out.text(), .err = err.text()};
}

PartnerProcess::PartnerProcess(const std::string& program, const std::vector<std::string>& words,
                               const SharedMemory& memory, std::pair<Doorbell, Doorbell> ends)
    : bell_(std::move(ends.first)),
      process_({.words = words,
                .program = program,
                .files = {0, 1, 2, ends.second.descriptor(), memory.descriptor()},
                .blocks_group_signals = true}) {}

std::string PartnerProcess::end() noexcept {
  shutdown(bell_.descriptor(), SHUT_RDWR);
  return process_.end();
}

}  // namespace kadans
