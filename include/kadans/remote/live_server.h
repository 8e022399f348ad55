// Serves a running instance, or a record, over one port: our page and its files by HTTP, everything that moves by the
// Foxglove WebSocket protocol. One thread of its own, at low priority; the engines never wait for it.
//
// It listens on the loopback address unless told otherwise. Who knows the token may write: parameters, orders, the
// emergency stop. Without it a client reads; a page from another site does not even that.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "kadans/remote/live_hub.h"

namespace kadans {

struct LiveSettings {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8765;  // 0: any that is free
  std::string token;          // "": a new one
};

// A server without an instance: a record to look at.
struct RecordSite {
  std::string file;  // served as /record.mcap
  // Of a page that was asked to draw (POST /frames/NAME, with the token): on the server's thread.
  std::function<void(const std::string& name, const std::string& bytes)> take_frame;
};

class LiveServer {
 public:
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
