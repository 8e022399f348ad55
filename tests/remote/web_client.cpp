#include "remote/web_client.h"

#include <array>
#include <cstdlib>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kadans::remote_test {

WebClient::WebClient(std::uint16_t port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
  close(socket_);
  socket_ = -1;
}

WebClient::~WebClient() {
  if (socket_ >= 0) close(socket_);
}

bool WebClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool WebClient::fill() {
  std::array<char, 65536> bytes;
  const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
  if (count > 0) in_.append(bytes.data(), static_cast<std::size_t>(count));
  return count > 0;
}

int WebClient::status() {
  std::size_t end = 0;
  while ((end = in_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) return 0;
  }
  const std::string head = in_.substr(0, end);
  in_.erase(0, end + 4);
  const std::size_t length_at = head.find("Content-Length: ");
  const std::size_t length =
      length_at == std::string::npos ? 0 : std::strtoul(head.c_str() + length_at + 16, nullptr, 10);
  while (in_.size() < length && fill()) {
  }
  body_ = in_.substr(0, length);
  in_.erase(0, length);
  return head.size() > 12 ? std::atoi(head.c_str() + 9) : 0;
}

int WebClient::get(std::string_view target, std::string_view host, std::string_view head) {
  std::string text = "GET ";
  text.append(target).append(" HTTP/1.1\r\nHost: ").append(host).append("\r\n").append(head).append("\r\n");
  return send(text) ? status() : 0;
}

int WebClient::upgrade(std::string_view target, std::string_view host, std::string_view head) {
  std::string lines =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n";
  return get(target, host, lines.append(head));
}

bool WebClient::say(std::string_view payload, bool binary) {
  std::string frame(1, static_cast<char>(binary ? 0x82 : 0x81));
  const std::uint64_t size = payload.size();
  const int bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
  frame += static_cast<char>(0x80U | (bytes == 0 ? size : bytes == 2 ? 126U : 127U));
  for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>(size >> (8U * static_cast<unsigned>(i)));
  frame.append(4, '\0');  // the mask
  return send(frame.append(payload));
}

std::optional<std::string> WebClient::hear() {
  const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(in_[i]); };
  const auto needs = [this](std::size_t count) {
    while (in_.size() < count) {
      if (!fill()) return false;
    }
    return true;
  };
  if (!needs(2)) return std::nullopt;
  std::size_t length = byte(1) & 0x7FU, head = 2;
  const std::size_t bytes = length == 126 ? 2 : length == 127 ? 8 : 0;
  if (!needs(head + bytes)) return std::nullopt;
  if (bytes > 0) length = 0;
  for (std::size_t i = 0; i < bytes; ++i) length = (length << 8U) | byte(head + i);
  head += bytes;
  if (!needs(head + length) || (byte(0) & 0xFU) == 8) return std::nullopt;  // 8: it says farewell
  std::string payload = in_.substr(head, length);
  in_.erase(0, head + length);
  return payload;
}

bool WebClient::ended() {
  while (fill()) {
  }
  return true;
}

}  // namespace kadans::remote_test
