// A client of a live server on this machine that speaks as much WebSocket (RFC 6455) as the bench needs: short frames
// out, whole messages in. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kadans::bench {

class WebSocket {
 public:
  // Connects and shakes hands. `receive_bytes`: the system's buffer, 0: as it likes. Throws std::runtime_error.
  explicit WebSocket(std::uint16_t port, int receive_bytes = 0);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  int descriptor() const noexcept { return socket_; }
  void send_text(std::string_view text);  // up to 65535 bytes
  // Takes what has come, without waiting; false: the other side closed.
  bool take();
  // The next whole message of what was taken, until the next call; binary ones begin with a byte below 32, texts with
  // '{'.
  std::optional<std::string_view> message();
  // Waits for it. Throws std::runtime_error after 20 s.
  std::string next_message();

 private:
  void send_all(std::string_view bytes) const;
  std::optional<std::string_view> part();

  int socket_ = -1;
  std::string in_;
  std::size_t at_ = 0;  // of in_ is read
  std::string parts_;   // of a message in several frames
  bool whole_ = true;
};

}  // namespace kadans::bench
