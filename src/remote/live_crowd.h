// The connections of a live server, and who goes when another one comes.
//
// Three kinds are counted apart: requests (whoever is not, or not yet, a client of the protocol), readers and writers.
// A request that is one too many takes the place of the one that was served longest ago, first of those without the
// token. A reader that is one too many is refused, unless it comes from this machine: then the oldest reader goes,
// first of those from elsewhere. So the operator and a page on this machine get in whatever strangers hold open.
// Server's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>

#include "kadans/remote/live_server.h"
#include "live_connection.h"

namespace kadans {

class LiveCrowd {
 public:
  void take(std::unique_ptr<LiveConnection> connection);
  // Before a connection becomes a client. False: there is none.
  [[nodiscard]] bool make_room(bool writes, bool local) noexcept;
  // Closes one request; false: there is none. For when the system has no more to give.
  bool close_one() noexcept;
  // Of connections in the order in which they were served.
  std::uint64_t next_turn() noexcept { return ++turns_; }
  // After the hub took what is new. Frees what is over.
  void beat() noexcept;
  std::uint32_t clients() const noexcept;

 private:
  using Standing = LiveConnection::Standing;
  std::size_t count(Standing standing) const noexcept;
  // Open, of this standing, and the first by `order`; nullptr: none.
  LiveConnection* first(Standing standing, bool (*order)(const LiveConnection&, const LiveConnection&)) noexcept;

  std::list<std::unique_ptr<LiveConnection>> connections_;
  std::uint64_t turns_ = 0;
};

}  // namespace kadans
