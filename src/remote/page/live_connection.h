// One connection of a live server: an HTTP request, or after an upgrade a WebSocket client of the protocol.
//
// The head of a request is read first. The body is read only when the request needs one and its sender may send one. An
// exception in a handler ends the connection and nothing else. Asynchronous operations refer to the connection by its
// address. So the connection counts the operations under way: over() is true when it is closed and none is left, and
// then it may be freed. Server's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/ip/tcp.hpp>

#include "live_server.h"

namespace kadans {

// Decides the rights of a request to a live server from its HTTP head alone.
//
// A browser lets any page open connections to any address, and the owner of a page can let his own host name point to
// our address (DNS rebinding). So a client without the token must call the server by one of the server's own names: the
// address at which the request came in, a loopback name, or a name from --live-host. A page of another site needs the
// token even when it uses such a name. A client with the token got it from the person who started the server.

// The fields of a request's head, and the address of this machine at which it came in.
struct Knock {
  std::string_view host, origin, token;  // "": field not given
  std::string reached_at;                // "127.0.0.1", "::1"
};

enum class Access { writes, reads, wrong_host, other_site };

class LiveAccess {
 public:
  // `hosts` are additional names of this server, without a port.
  LiveAccess(std::string token, std::vector<std::string> hosts);

  Access of(const Knock& knock) const;
  const std::string& token() const noexcept { return token_; }
  // The text for a refused client.
  static const char* why(Access refused) noexcept;

 private:
  bool is_ours(std::string_view host, const std::string& reached_at) const;

  std::string token_;
  std::vector<std::string> hosts_;
};

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

// The connections of a live server. It decides which connection is closed when there is no room for a new one.
//
// Three kinds are counted separately: requests (connections that are not, or not yet, clients of the protocol), readers
// and writers. When there are too many requests, the one that was served longest ago is closed; those without the token
// go first. When there are too many readers, a new reader is refused. But a reader on this machine replaces the oldest
// reader; those from other machines go first. So the operator and a page on this machine always get in, whatever
// connections strangers hold open. Server's thread.
class LiveCrowd {
 public:
  void take(std::unique_ptr<LiveConnection> connection);
  // To be called before a connection becomes a client. False: there is no room.
  [[nodiscard]] bool make_room(bool writes, bool local) noexcept;
  // Closes one request; false: there is none. For the case that the system has no more descriptors.
  bool close_one() noexcept;
  // A number that counts up each time that a connection is served.
  std::uint64_t next_turn() noexcept { return ++turns_; }
  // To be called after each beat of the hub. Frees the connections that are over.
  void beat() noexcept;
  std::uint32_t clients() const noexcept;

 private:
  using Standing = LiveConnection::Standing;
  std::size_t count(Standing standing) const noexcept;
  // The first by `order` of the open connections with this standing; nullptr: none.
  LiveConnection* first(Standing standing, bool (*order)(const LiveConnection&, const LiveConnection&)) noexcept;

  std::list<std::unique_ptr<LiveConnection>> connections_;
  std::uint64_t turns_ = 0;
};

}  // namespace kadans
