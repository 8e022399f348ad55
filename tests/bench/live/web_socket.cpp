#include "bench/live/web_socket.h"

#include <array>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kadans::bench {
namespace {

constexpr int patience_ms = 20'000;
constexpr std::size_t chunk_bytes = 65'536;

}  // namespace

WebSocket::WebSocket(std::uint16_t port, int receive_bytes) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_bytes > 0) (void)setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("the live server does not answer");
  send_all("GET / HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n");
  std::size_t end = std::string::npos;
  while ((end = in_.find("\r\n\r\n")) == std::string::npos) {
    pollfd wait{socket_, POLLIN, 0};
    if (poll(&wait, 1, patience_ms) <= 0 || !take()) throw std::runtime_error("the live server shakes no hands");
  }
  if (in_.compare(0, 12, "HTTP/1.1 101") != 0) throw std::runtime_error("refused: " + in_.substr(0, end));
  at_ = end + 4;
}

WebSocket::~WebSocket() { close(socket_); }

void WebSocket::send_all(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) throw std::runtime_error("the live server closed");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

// With a mask of zeros, so the text stays as it is.
void WebSocket::send_text(std::string_view text) {
  constexpr std::size_t short_max = 125;  // a length that fits must stand in the first byte
  const bool is_short = text.size() <= short_max;
  std::string frame{static_cast<char>(0x81), static_cast<char>(0x80U | (is_short ? text.size() : 126U))};
  if (!is_short) frame += {static_cast<char>(text.size() >> 8U), static_cast<char>(text.size() & 0xffU)};
  frame.append(4, '\0');
  send_all(frame.append(text));
}

bool WebSocket::take() {
  if (at_ > 0 && at_ >= in_.size() / 2) {
    in_.erase(0, at_);
    at_ = 0;
  }
  const std::size_t before = in_.size();
  in_.resize(before + chunk_bytes);
  const ssize_t count = recv(socket_, in_.data() + before, chunk_bytes, MSG_DONTWAIT);
  in_.resize(before + (count > 0 ? static_cast<std::size_t>(count) : 0));
  return count > 0 || (count < 0 && errno == EAGAIN);
}

std::optional<std::string_view> WebSocket::part() {
  const std::size_t left = in_.size() - at_;
  if (left < 2) return std::nullopt;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint64_t>(static_cast<unsigned char>(in_[at_ + i])); };
  std::uint64_t size = byte(1) & 0x7fU;
  const std::size_t more = size == 126 ? 2 : size == 127 ? 8 : 0;
  if (left < 2 + more) return std::nullopt;
  if (more > 0) size = 0;
  for (std::size_t i = 0; i < more; ++i) size = size << 8U | byte(2 + i);
  if (left - 2 - more < size) return std::nullopt;
  const std::string_view body(in_.data() + at_ + 2 + more, static_cast<std::size_t>(size));
  at_ += 2 + more + body.size();
  return body;
}

std::optional<std::string_view> WebSocket::message() {
  for (;;) {
    const std::size_t head = at_;
    const auto body = part();
    if (!body) return std::nullopt;
    const bool last = (static_cast<unsigned char>(in_[head]) & 0x80U) != 0;
    if (last && whole_) return body;
    if (whole_) parts_.clear();
    parts_ += *body;
    whole_ = last;
    if (last) return parts_;
  }
}

std::string WebSocket::next_message() {
  for (;;) {
    if (const auto body = message()) return std::string(*body);
    pollfd wait{socket_, POLLIN, 0};
    if (poll(&wait, 1, patience_ms) <= 0 || !take()) throw std::runtime_error("the live server says no more");
  }
}

}  // namespace kadans::bench
