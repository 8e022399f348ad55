// One connection of a live server: an HTTP request, or after an upgrade a WebSocket client of the protocol.
//
// The head of a request is read first. The body is read only when the request needs one and its sender may send one. An
// exception in a handler ends the connection and nothing else. Asynchronous operations refer to the connection by its
// address. So the connection counts the operations under way: over() is true when it is closed and none is left, and
// then it may be freed. Server's thread.
#pragma once

#include <cstdint>
#include <memory>

#include <boost/asio/ip/tcp.hpp>

#include "live_access.h"
#include "live_server.h"

namespace kadans {

class LiveCrowd;

// The parts of the server that connections need.
struct LiveSite {
  LiveHub* hub = nullptr;
  RecordSite record;
  LiveAccess access;
  LiveCrowd* crowd = nullptr;
};

class LiveConnection {
 public:
  enum class Standing : std::uint8_t { request, reader, writer };

  virtual ~LiveConnection() = default;
  virtual void start() = 0;
  virtual void beat() noexcept = 0;  // called after each beat of the hub
  virtual void close() noexcept = 0;

  virtual Standing standing() const noexcept = 0;
  virtual bool closed() const noexcept = 0;
  virtual bool over() const noexcept = 0;
  virtual bool local() const noexcept = 0;          // the client is on this machine
  virtual bool trusted() const noexcept = 0;        // the client has the token
  virtual std::uint64_t turn() const noexcept = 0;  // LiveCrowd::next_turn() when it was last served
};

std::unique_ptr<LiveConnection> make_live_connection(boost::asio::ip::tcp::socket socket, const LiveSite& site,
                                                     std::uint64_t id);

}  // namespace kadans
