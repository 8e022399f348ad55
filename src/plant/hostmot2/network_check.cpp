#include <array>
#include <memory>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

#include "settings.h"

namespace kadans::hostmot2 {
namespace {

std::uint32_t ipv4(const sockaddr* address) { return reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr; }

std::string text_of(std::uint32_t address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

// IFF_LOWER_UP of linux/if.h, which cannot be included beside net/if.h: there is a cable with something at its other
// end. IFF_RUNNING follows it, up to a second later.
constexpr unsigned carrier = 1U << 16;

}  // namespace

PlantType::Finding examine_card(const BoardSettings& board) {
  const auto found = [&](bool good, const std::string& is, const std::string& how) {
    return PlantType::Finding{.topic = "board " + board.name,
                              .good = good,
                              .is = board.address + ": " + is,
                              .should = "a network card of this machine in its network",
                              .how = how};
  };
  const std::string host = board.address.substr(0, board.address.find(':'));
  in_addr wanted{};
  if (inet_pton(AF_INET, host.c_str(), &wanted) != 1)
    return found(false, "no address", "an address such as 192.168.1.121");
  ifaddrs* first = nullptr;
  (void)getifaddrs(&first);
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> cards(first, freeifaddrs);
  for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next) {
    if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET || at->ifa_netmask == nullptr) continue;
    if (((ipv4(at->ifa_addr) ^ wanted.s_addr) & ipv4(at->ifa_netmask)) != 0) continue;
    const std::string card = std::string(at->ifa_name) + " (" + text_of(ipv4(at->ifa_addr)) + ")";
    if ((at->ifa_flags & IFF_UP) == 0)
      return found(false, card + " is down", std::string("sudo ip link set ") + at->ifa_name + " up");
    if ((at->ifa_flags & carrier) == 0)
      return found(false, card + " has no cable in, or nothing is powered at its other end", "plug the cable in");
    return found(true, card + " is in its network", "");
  }
  return found(false, "no network card of this machine is in the network of " + host,
               "give the card to it an address there, such as `sudo ip address add " + host.substr(0, host.rfind('.')) +
                   ".1/24 dev eth0`");
}

std::vector<PlantType::Finding> examine_boards(const HostMot2Settings& settings, std::int64_t control_period_ns) {
  std::vector<PlantType::Finding> findings;
  for (const BoardSettings& board : settings.boards) {
    if (!board.resource.empty()) {
      const bool there = access(board.resource.c_str(), R_OK | W_OK) == 0;
      findings.push_back({.topic = "board " + board.name,
                          .good = there,
                          .is = board.resource + (there ? " may be opened" : " is not there, or may not be opened"),
                          .should = "the file of the card's registers",
                          .how = "`lspci` shows the card; a rule for udev may give the file to a group"});
      continue;
    }
    findings.push_back(examine_card(board));
  }
  const double periods = 1e9 * settings.watchdog_s / static_cast<double>(control_period_ns);
  findings.push_back({.topic = "watchdog",
                      .good = periods >= 3,
                      .is = "after " + std::to_string(static_cast<int>(periods)) + " control periods of silence",
                      .should = "at least 3",
                      .how = "a longer plant.hm2-eth.watchdog_s: a tick that is late would release the joints"});
  return findings;
}

}  // namespace kadans::hostmot2
