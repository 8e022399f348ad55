// One connection of a live server: an HTTP request, or what became of it by an upgrade, a client of the protocol.
//
// Asynchronous operations refer to the connection by its address. It counts those under way and reports itself over
// when it is closed and none is left; the server then frees it. Server's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <boost/asio/ip/tcp.hpp>

#include "kadans/remote/live_server.h"

namespace kadans {

// What connections need of their server.
struct LiveSite {
  LiveHub* hub = nullptr;
  RecordSite record;
  std::string token;
};

class LiveConnection {
 public:
  virtual ~LiveConnection() = default;
  virtual void start() = 0;
  virtual void beat() = 0;  // the hub took what is new
  virtual void close() = 0;
  virtual bool over() const noexcept = 0;
  virtual bool is_client() const noexcept = 0;
};

std::unique_ptr<LiveConnection> make_live_connection(boost::asio::ip::tcp::socket socket, const LiveSite& site,
                                                     std::uint64_t id);

}  // namespace kadans
