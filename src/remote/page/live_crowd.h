// The connections of a live server. It decides which connection is closed when there is no room for a new one.
//
// Three kinds are counted separately: requests (connections that are not, or not yet, clients of the protocol), readers
// and writers. When there are too many requests, the one that was served longest ago is closed; those without the token
// go first. When there are too many readers, a new reader is refused. But a reader on this machine replaces the oldest
// reader; those from other machines go first. So the operator and a page on this machine always get in, whatever
// connections strangers hold open. Server's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>

#include "live_connection.h"
#include "live_server.h"

namespace kadans {

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
