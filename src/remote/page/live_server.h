// Serves a running instance or a record over one port: the web page and its files by HTTP, live data by the Foxglove
// WebSocket protocol. It has one thread of its own at low priority, and the engines never wait for it.
//
// It listens on the loopback address unless LiveSettings names another one. A client with the token may write:
// parameters, orders, the emergency stop. A client without the token may only read, and only if it calls the server by
// one of its names. A page from another site may not even read (live_connection.h).
//
// Clients can neither end the server nor make it grow without bound (docs/security.md lists the bounds). At most
// `requests_max` requests are served at a time. When another one comes, the oldest request without the token is closed,
// so nobody can keep others out by holding connections open. Readers and writers are counted separately.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "live_hub.h"

namespace kadans {

struct LiveSettings {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8765;         // 0: any free port
  std::string token;                 // "": the server makes a new one
  std::vector<std::string> hosts{};  // names for clients without the token, beside the server's addresses
};

// A server without an instance shows a record.
struct RecordSite {
  std::string file;  // served as /record.mcap
  // Takes the pictures of a page that was asked to draw (POST /frames/NAME, with the token). Called on the server's
  // thread.
  std::function<void(const std::string& name, const std::string& bytes)> take_frame;
  // A mesh of the robot, by its name in the URDF (GET /asset/NAME); nullptr: there is none. On the server's thread.
  std::function<std::shared_ptr<const std::string>(std::string_view name)> read_mesh{};
};

class LiveServer {
 public:
  // The greatest number of connections at a time: requests (a page's files, a record), clients without and with the
  // token.
  static constexpr std::size_t requests_max = 64, readers_max = 200, writers_max = 36;

  // Opens the port. Throws InputError when the port is taken. `hub` may be nullptr; else it must outlive the server.
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

}  // namespace kadans
