// Decides the rights of a request to a live server from its HTTP head alone.
//
// A browser lets any page open connections to any address, and the owner of a page can let his own host name point to
// our address (DNS rebinding). So a client without the token must call the server by one of the server's own names: the
// address at which the request came in, a loopback name, or a name from --live-host. A page of another site needs the
// token even when it uses such a name. A client with the token got it from the person who started the server.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kadans {

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

}  // namespace kadans
