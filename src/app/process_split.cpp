#include "process_split.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include <sys/wait.h>
#include <unistd.h>

#include "terminal.h"

namespace kadans {

struct ProcessSplit::Child {
  pid_t pid = -1;
  std::FILE* said = nullptr;
  bool running = true;
  int exit_code = exit_internal;

  Child() = default;
  ~Child() {
    if (said != nullptr) std::fclose(said);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
};

ProcessSplit::ProcessSplit() = default;
ProcessSplit::~ProcessSplit() = default;

bool ProcessSplit::split(std::size_t at_once) {
  const auto running = [this] { return std::ranges::count_if(children_, [](const auto& c) { return c->running; }); };
  while (running() >= static_cast<std::ptrdiff_t>(std::max<std::size_t>(at_once, 1))) wait_for_one();
  auto child = std::make_unique<Child>();
  child->said = std::tmpfile();
  if (child->said == nullptr) throw std::system_error(errno, std::generic_category(), "a temporary file");
  std::fflush(nullptr);
  child->pid = fork();
  if (child->pid < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child->pid > 0) {
    children_.push_back(std::move(child));
    return false;
  }
  (void)dup2(fileno(child->said), STDOUT_FILENO);
  return true;
}

void ProcessSplit::wait_for_one() {
  int status = 0;
  const pid_t pid = waitpid(-1, &status, 0);
  if (pid < 0 && errno == EINTR) return;  // the children got the signal, too
  for (const auto& child : children_) {
    if (!child->running || (pid >= 0 && child->pid != pid)) continue;
    child->running = false;
    if (pid >= 0 && WIFEXITED(status)) child->exit_code = WEXITSTATUS(status);
  }
}

int ProcessSplit::finish() {
  while (std::ranges::any_of(children_, [](const auto& child) { return child->running; })) wait_for_one();
  int worst = exit_passed;
  for (const auto& child : children_) {
    worst = std::max(worst, child->exit_code);
    std::rewind(child->said);
    char block[4096];
    for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, child->said)) > 0;)
      std::fwrite(block, 1, got, stdout);
  }
  children_.clear();
  std::fflush(stdout);
  return worst;
}

}  // namespace kadans
