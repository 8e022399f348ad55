#include "run_channel.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "config/json/foreign_json.h"

namespace kadans {
namespace {

bool receive_all(int socket, char* bytes, std::size_t size) noexcept {
  while (size > 0) {
    const ssize_t got = ::recv(socket, bytes, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

// The length of the text comes first, and with its first byte the descriptor.
struct Head {
  std::uint32_t length = 0;
  iovec part{&length, sizeof length};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> room{};
  msghdr message{};

  Head() {
    message.msg_iov = &part;
    message.msg_iovlen = 1;
  }
  void make_room() noexcept {
    message.msg_control = room.data();
    message.msg_controllen = room.size();
  }
};

}  // namespace

bool write_all(int descriptor, std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::pair<RunChannel, RunChannel> RunChannel::make_pair() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::system_error(errno, std::generic_category(), "socketpair");
  return {RunChannel(ends[0]), RunChannel(ends[1])};
}

bool RunChannel::send(const Json& json, const RunChannel* end) const noexcept {
  const std::string text = json_text(json);
  Head head;
  head.length = static_cast<std::uint32_t>(text.size());
  if (end != nullptr) {
    head.make_room();
    cmsghdr* const given = CMSG_FIRSTHDR(&head.message);
    given->cmsg_level = SOL_SOCKET;
    given->cmsg_type = SCM_RIGHTS;
    given->cmsg_len = CMSG_LEN(sizeof(int));
    const int its = end->socket();
    std::memcpy(CMSG_DATA(given), &its, sizeof its);
  }
  ssize_t sent = 0;
  do sent = sendmsg(socket(), &head.message, MSG_NOSIGNAL);
  while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(sizeof head.length) && write_all(socket(), text);
}

std::optional<Json> RunChannel::receive(RunChannel* end) const {
  Head head;
  head.make_room();
  ssize_t got = 0;
  do got = recvmsg(socket(), &head.message, MSG_CMSG_CLOEXEC);
  while (got < 0 && errno == EINTR);
  if (got <= 0) return std::nullopt;
  if (const cmsghdr* given = CMSG_FIRSTHDR(&head.message); given != nullptr && given->cmsg_type == SCM_RIGHTS) {
    int descriptor = -1;
    std::memcpy(&descriptor, CMSG_DATA(given), sizeof(int));
    RunChannel taken(descriptor);
    if (end != nullptr) *end = std::move(taken);
  }
  const auto rest = static_cast<std::size_t>(got);
  if (!receive_all(socket(), reinterpret_cast<char*>(&head.length) + rest, sizeof head.length - rest))
    return std::nullopt;
  std::string text(head.length, '\0');
  if (!receive_all(socket(), text.data(), text.size())) return std::nullopt;
  return read_foreign_json(text);
}

bool RunChannel::waiting() const noexcept {
  pollfd one{socket(), POLLIN, 0};
  return poll(&one, 1, 0) > 0;
}

}  // namespace kadans
