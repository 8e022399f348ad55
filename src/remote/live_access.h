// Who may do what on a live server, told from the head of a request alone.
//
// A browser lets any page open connections to any address, and a page may give its own name our address (DNS
// rebinding). So a client without the token must call the server by a name that is the server's: an address that it was
// reached at, a name of the loopback, or one that --live-host adds. A page of another site needs the token, too, even
// if it calls us rightly. Who has the token got it from the person who started the server.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kadans {

// What a request says of itself, and the address of this machine that it came to.
struct Knock {
  std::string_view host, origin, token;  // "": not given
  std::string reached_at;                // "127.0.0.1", "::1"
};

enum class Access { writes, reads, wrong_host, other_site };

class LiveAccess {
 public:
  // `hosts`: names beside those of the addresses, without a port.
  LiveAccess(std::string token, std::vector<std::string> hosts);

  Access of(const Knock& knock) const;
  const std::string& token() const noexcept { return token_; }
  // For who is refused.
  static const char* why(Access refused) noexcept;

 private:
  bool is_ours(std::string_view host, const std::string& reached_at) const;

  std::string token_;
  std::vector<std::string> hosts_;
};

}  // namespace kadans
