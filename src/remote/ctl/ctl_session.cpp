#include "ctl_session.h"

#include <array>
#include <cerrno>

#include <sys/socket.h>
#include <unistd.h>

namespace kadans {

CtlSession::CtlSession(int socket, Role role, std::uint64_t number, std::int64_t now_ns)
    : socket_(socket), role_(role), number_(number), heard_ns_(now_ns) {
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known = getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
  if (known) user_ = peer.uid;
  who_ = (known ? "uid " + std::to_string(user_) + " (" : std::string("(")) + name(role) + ")";
}

CtlSession::~CtlSession() { close(socket_); }

void CtlSession::note_half(std::int64_t now_ns) noexcept {
  if (in_.empty() || has_line()) {
    half_ns_ = INT64_MAX;
  } else if (half_ns_ == INT64_MAX) {
    half_ns_ = now_ns;
  }
}

bool CtlSession::receive(std::int64_t now_ns) {
  std::array<char, 16384> bytes;
  const ssize_t count = recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  ended_ = count == 0;
  if (count > 0) heard_ns_ = now_ns;
  in_.append(bytes.data(), static_cast<std::size_t>(count));
  note_half(now_ns);
  return !too_long();
}

bool CtlSession::transmit(std::int64_t now_ns) {
  const ssize_t count = send(socket_, out_.data(), out_.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  if (count > 0) progress_ns_ = now_ns;
  out_.erase(0, static_cast<std::size_t>(count));
  return true;
}

bool CtlSession::take_line(std::string& line, std::int64_t now_ns) {
  if (!out_.empty() || order != 0) return false;
  const std::size_t end = in_.find('\n');
  if (end == std::string::npos) return false;
  line.assign(in_, 0, end);
  in_.erase(0, end + 1);
  note_half(now_ns);
  return true;
}

void CtlSession::say(const std::string& line, std::int64_t now_ns) {
  if (out_.empty()) progress_ns_ = now_ns;
  out_ += line;
  out_ += '\n';
}

}  // namespace kadans
