// One connection of a live server: an HTTP request, or what became of it by an upgrade, a client of the protocol.
//
// Of a request the head is read first, and a body only where one is wanted of whoever sends it. An exception in a
// handler ends the connection and nothing else. Asynchronous operations refer to the connection by its address: it
// counts those under way and reports itself over when it is closed and none is left; then it may be freed. Server's
// thread.
#pragma once

#include <cstdint>
#include <memory>

#include <boost/asio/ip/tcp.hpp>

#include "kadans/remote/live_server.h"
#include "live_access.h"

namespace kadans {

class LiveCrowd;

// What connections need of their server.
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
  virtual void beat() noexcept = 0;  // the hub took what is new
  virtual void close() noexcept = 0;

  virtual Standing standing() const noexcept = 0;
  virtual bool closed() const noexcept = 0;
  virtual bool over() const noexcept = 0;
  virtual bool local() const noexcept = 0;          // from this machine
  virtual bool trusted() const noexcept = 0;        // came with the token
  virtual std::uint64_t turn() const noexcept = 0;  // when it was served last
};

std::unique_ptr<LiveConnection> make_live_connection(boost::asio::ip::tcp::socket socket, const LiveSite& site,
                                                     std::uint64_t id);

}  // namespace kadans
