#include "live_access.h"

#include <algorithm>

namespace kadans {
namespace {

// All characters are looked at, so that the time tells nothing.
bool same(std::string_view a, std::string_view b) noexcept {
  unsigned difference = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0 && !b.empty();
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

// "[::1]:8765" -> "::1", "localhost:8765" -> "localhost"; "" where it is none.
std::string name_in(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos || (end + 1 < host.size() && host[end + 1] != ':')) return "";
    return in_lower_case(host.substr(1, end - 1));
  }
  return in_lower_case(host.substr(0, host.find(':')));
}

// "http://localhost:8765" -> "localhost:8765"
std::string_view site_in(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return origin.substr(scheme.size());
  }
  return {};
}

}  // namespace

LiveAccess::LiveAccess(std::string token, std::vector<std::string> hosts)
    : token_(std::move(token)), hosts_(std::move(hosts)) {
  for (std::string& host : hosts_) host = in_lower_case(host);
}

bool LiveAccess::is_ours(std::string_view host, const std::string& reached_at) const {
  const std::string name = name_in(host);
  if (name.empty()) return false;
  if (name == reached_at || name == "localhost" || name == "127.0.0.1" || name == "::1") return true;
  return std::ranges::find(hosts_, name) != hosts_.end();
}

Access LiveAccess::of(const Knock& knock) const {
  if (same(knock.token, token_)) return Access::writes;
  if (!is_ours(knock.host, knock.reached_at)) return Access::wrong_host;
  if (!knock.origin.empty() && in_lower_case(site_in(knock.origin)) != in_lower_case(knock.host))
    return Access::other_site;
  return Access::reads;
}

const char* LiveAccess::why(Access refused) noexcept {
  if (refused == Access::other_site) return "a page of another site needs the token\n";
  return "this server is not called so; without the token use its address, or start it with --live-host NAME\n";
}

}  // namespace kadans
