// Gnuplot as a child: the script through one pipe, the picture back through another, both at once, so that neither side
// waits for the other with a full pipe.
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "kadans/telemetry/signal_plot.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX asks for it

namespace kadans {
namespace {

[[noreturn]] void fail_with(int error, const char* what) {
  throw std::system_error(error, std::generic_category(), what);
}

struct Descriptor {
  int number = -1;
  Descriptor() = default;
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  void close() noexcept {
    if (number >= 0) ::close(number);
    number = -1;
  }
};

struct Pipe {
  Descriptor ours, theirs;
};

void open_pipe(Pipe& pipe) {  // a socket, since a write to a dead child is to fail, not to end this process
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail_with(errno, "a pipe to gnuplot");
  pipe.ours.number = ends[0];
  pipe.theirs.number = ends[1];
  (void)fcntl(ends[0], F_SETFL, O_NONBLOCK);
}

class Gnuplot {
 public:
  Gnuplot() {
    open_pipe(in_);
    open_pipe(out_);
    open_pipe(err_);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in_.theirs.number, 0);
    posix_spawn_file_actions_adddup2(&files, out_.theirs.number, 1);
    posix_spawn_file_actions_adddup2(&files, err_.theirs.number, 2);
    std::string name = "gnuplot", settings = "-d";  // nobody's settings but ours
    char* arguments[] = {name.data(), settings.data(), nullptr};
    const int failed = posix_spawnp(&pid_, "gnuplot", &files, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&files);
    if (failed == ENOENT)
      throw InputError({.message = "plots are drawn by gnuplot, which is not here: install the package gnuplot-nox"});
    if (failed != 0) fail_with(failed, "gnuplot");
    for (Pipe* pipe : {&in_, &out_, &err_}) pipe->theirs.close();
  }
  ~Gnuplot() {
    if (pid_ < 0) return;
    (void)kill(pid_, SIGKILL);
    (void)waitpid(pid_, nullptr, 0);
  }
  Gnuplot(const Gnuplot&) = delete;
  Gnuplot& operator=(const Gnuplot&) = delete;

  std::string draw(const std::string& script) {
    std::string picture, said;
    std::size_t sent = 0;
    while (out_.ours.number >= 0 || err_.ours.number >= 0) {
      pollfd waited[] = {{in_.ours.number, POLLOUT, 0}, {out_.ours.number, POLLIN, 0}, {err_.ours.number, POLLIN, 0}};
      if (poll(waited, 3, -1) < 0 && errno != EINTR) fail_with(errno, "gnuplot");
      if (waited[0].revents != 0) feed(script, sent);
      if (waited[1].revents != 0) take(out_.ours, picture);
      if (waited[2].revents != 0) take(err_.ours, said);
    }
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || picture.empty())
      throw InputError({.message = "gnuplot failed: " + said.substr(0, 500)});
    return picture;
  }

 private:
  void feed(const std::string& script, std::size_t& sent) {
    const ssize_t count = send(in_.ours.number, script.data() + sent, script.size() - sent, MSG_NOSIGNAL);
    if (count > 0) sent += static_cast<std::size_t>(count);
    const bool broken = count < 0 && errno != EAGAIN && errno != EINTR;
    if (broken || sent == script.size()) in_.ours.close();
  }

  static void take(Descriptor& from, std::string& to) {
    char bytes[65536];
    const ssize_t count = read(from.number, bytes, sizeof bytes);
    if (count > 0) to.append(bytes, static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) from.close();
  }

  Pipe in_, out_, err_;
  pid_t pid_ = -1;
};

}  // namespace

std::string draw(const SignalPlot& plot, PlotFormat format, PlotSize size) {
  return Gnuplot().draw(gnuplot_script(plot, format, size));
}

}  // namespace kadans
