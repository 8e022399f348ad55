// Serves a running instance, or a record, over one port: our page and its files by HTTP, everything that moves by the
// Foxglove WebSocket protocol. One thread of its own, at low priority; the engines never wait for it.
//
// It listens on the loopback address unless told otherwise. Who knows the token may write: parameters, orders, the
// emergency stop. Without it a client reads, if it calls the server by one of its names; a page from another site does
// not even that (src/remote/live_access.h).
//
// Nothing that clients do ends it or grows without bound (docs/security.md has the bounds). Requests are served in a
// crowd of at most `requests_max`, of which the oldest that has not come with the token goes when another one knocks;
// so whoever holds connections open keeps nobody out. Readers and those with the token are counted apart.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kadans/remote/live_hub.h"

namespace kadans {

struct LiveSettings {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8765;         // 0: any that is free
  std::string token;                 // "": a new one
  std::vector<std::string> hosts{};  // names that clients without the token may call it by, beside its addresses
};

// A server without an instance: a record to look at.
struct RecordSite {
  std::string file;  // served as /record.mcap
  // Of a page that was asked to draw (POST /frames/NAME, with the token): on the server's thread.
  std::function<void(const std::string& name, const std::string& bytes)> take_frame;
};

class LiveServer {
 public:
  // Connections at a time: of requests (a page's files, a record), clients without and with the token.
  static constexpr std::size_t requests_max = 64, readers_max = 200, writers_max = 36;

  // Opens the port. Throws InputError when it is taken. `hub` may be null; what is given must outlive the server.
  LiveServer(LiveSettings settings, LiveHub* hub, RecordSite site = {});
  ~LiveServer();  // stops
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  void start();
  void stop() noexcept;

  std::uint16_t port() const noexcept;
  const std::string& token() const noexcept;
  std::string url() const;  // with the token
  std::uint32_t clients() const noexcept;

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

// 128 random bits from the system, in hexadecimal.
std::string new_token();

}  // namespace kadans
