// A client of the live server that keeps no rules: bytes over TCP, HTTP heads, frames of WebSockets (RFC 6455).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kadans::remote_test {

class WebClient {
 public:
  explicit WebClient(std::uint16_t port);  // on the loopback
  ~WebClient();
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  bool send(std::string_view bytes);  // false: the other side closed
  // GET, with `head` lines after the Host; the status, 0 when the connection ended without one.
  int get(std::string_view target, std::string_view host, std::string_view head = "");
  int status();  // of the next answer; its body is read, too
  const std::string& body() const { return body_; }
  // As a client of the protocol.
  int upgrade(std::string_view target, std::string_view host, std::string_view head = "");
  bool say(std::string_view payload, bool binary = false);  // one frame
  std::optional<std::string> hear();                        // the next frame's payload; none: the connection ended
  bool ended();                                             // waits until it does

 private:
  bool fill();  // with more bytes; false: it ended

  int socket_ = -1;
  std::string in_, body_;
};

}  // namespace kadans::remote_test
