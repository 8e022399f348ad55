#include "child.h"

#include <algorithm>
#include <stdexcept>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "report.h"

namespace kadans::bench {
namespace {

pid_t start(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t silence;
  posix_spawn_file_actions_init(&silence);
  posix_spawn_file_actions_addopen(&silence, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawn(&child, arguments[0], &silence, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&silence);
  if (error != 0) throw std::runtime_error("cannot start " + command[0]);
  return child;
}

}  // namespace

Usage run_children(const std::vector<std::string>& command, int count) {
  const double began = now_ns();
  std::vector<pid_t> children;
  for (int i = 0; i < count; ++i) children.push_back(start(command));
  Usage usage;
  for (const pid_t child : children) {
    int status = 0;
    rusage used{};
    if (wait4(child, &status, 0, &used) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
      throw std::runtime_error(command[0] + " failed");
    }
    usage.resident_mb = std::max(usage.resident_mb, static_cast<double>(used.ru_maxrss) / 1024);
  }
  usage.wall_ms = 1e-6 * (now_ns() - began);
  return usage;
}

}  // namespace kadans::bench
