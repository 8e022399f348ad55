#include "keys.h"

#include <cerrno>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace kadans {

Keys::Keys() : flags_(fcntl(STDIN_FILENO, F_GETFL)) {
  is_terminal_ = tcgetattr(STDIN_FILENO, &before_) == 0;
  if (is_terminal_) {
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    (void)tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  (void)fcntl(STDIN_FILENO, F_SETFL, flags_ | O_NONBLOCK);
}

Keys::~Keys() {
  (void)fcntl(STDIN_FILENO, F_SETFL, flags_);
  if (is_terminal_) (void)tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

std::string_view Keys::pressed(bool& gone) noexcept {
  pollfd here{STDIN_FILENO, POLLIN, 0};
  (void)poll(&here, 1, 0);
  const ssize_t got = read(STDIN_FILENO, keys_, sizeof keys_);
  // A terminal without a key reads as 0 bytes, too.
  const bool hung_up = (here.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  gone = got <= 0 && (hung_up || (got == 0 && !is_terminal_) || (got < 0 && errno != EAGAIN && errno != EINTR));
  return {keys_, got > 0 ? static_cast<std::size_t>(got) : 0};
}

}  // namespace kadans
