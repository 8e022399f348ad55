#include "single_precision.h"

#include <cstdio>
#include <stdexcept>

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kadans::bench {

SinglePrecisionRun::SinglePrecisionRun() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw std::runtime_error("no socket pair");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO}) posix_spawn_file_actions_adddup2(&actions, ends[1], stream);
  std::string program = KADANS_SINGLE_PRECISION;
  char* const arguments[] = {program.data(), nullptr};
  const int error = posix_spawn(&child_, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  socket_ = ends[0];
  if (error != 0) throw std::runtime_error("cannot start " + program);
}

SinglePrecisionRun::~SinglePrecisionRun() {
  close(socket_);
  waitpid(child_, nullptr, 0);
}

void SinglePrecisionRun::turn() {
  char done = 't';
  if (write(socket_, &done, 1) != 1 || read(socket_, &done, 1) != 1) {
    throw std::runtime_error("the plant in single precision has ended");
  }
}

SinglePrecision SinglePrecisionRun::end() {
  shutdown(socket_, SHUT_WR);
  std::string text;
  char letters[256];
  for (ssize_t n = 0; (n = read(socket_, letters, sizeof letters)) > 0;) {
    text.append(letters, static_cast<std::size_t>(n));
  }
  SinglePrecision result;
  if (std::sscanf(text.c_str(), "%lf %lf %d", &result.step_us, &result.drift_mm, &result.contact_count) != 3) {
    throw std::runtime_error("the plant in single precision said '" + text + "'");
  }
  return result;
}

}  // namespace kadans::bench
