#include "board_server.h"

#include <algorithm>
#include <array>
#include <limits>

#include "kadans/signal/input_error.h"
#include "signal/input_file.h"

namespace kadans::hostmot2 {

BoardServer::BoardServer(const HostMot2Settings& settings, const PlantSite& site)
    : DriveServer(site.layout.period_ns, settings.bus_divisor(site.layout.period_ns)),
      machine_(settings, site, site.seed),
      peers_(settings.boards.size()) {
  try {
    settings.require_ethernet();
    for (const BoardSettings& board : settings.boards)
      sockets_.emplace_back(listening_socket(board_place(board.address)));
  } catch (const InputError& error) {
    refuse("--listen", error.problems().front().message);
  }
}

BoardServer::~BoardServer() { end(); }

std::int64_t BoardServer::serve_bus(std::int64_t now_ns) noexcept {
  std::array<std::uint8_t, 2048> bytes;
  std::int64_t wake_ns = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < sockets_.size(); ++i) {
    EmulatedWire& wire = machine_.wire(i);
    for (;;) {
      PeerAddress from;
      from.size = sizeof from.address;
      auto* const address = reinterpret_cast<sockaddr*>(&from.address);
      const ssize_t got = recvfrom(sockets_[i].number(), bytes.data(), bytes.size(), MSG_DONTWAIT, address, &from.size);
      if (got < 0) break;
      peers_[i] = from;
      wire.receive({bytes.data(), static_cast<std::size_t>(got)}, now_ns);
    }
    for (std::vector<std::uint8_t> reply = wire.take(now_ns); !reply.empty(); reply = wire.take(now_ns)) {
      const auto* const address = reinterpret_cast<const sockaddr*>(&peers_[i].address);
      (void)sendto(sockets_[i].number(), reply.data(), reply.size(), MSG_DONTWAIT | MSG_NOSIGNAL, address,
                   peers_[i].size);
    }
    wake_ns = std::min(wake_ns, wire.due_ns());
  }
  return wake_ns;
}

std::uint64_t BoardServer::heard() const noexcept {
  std::uint64_t heard = 0;
  for (const EmulatedWire& wire : machine_.wires())
    heard += wire.responder.datagrams() - wire.responder.not_understood();
  return heard;
}

// Each board gets a datagram in a cycle; one whose cable is out does not hear it, but it was sent.
std::uint64_t BoardServer::cycles() const noexcept {
  std::uint64_t most = 0;
  for (const EmulatedWire& wire : machine_.wires()) most = std::max(most, wire.sent_to());
  return most;
}

std::vector<PlantCount> BoardServer::counts() const {
  std::uint64_t not_understood = 0;
  for (const EmulatedWire& wire : machine_.wires()) not_understood += wire.responder.not_understood();
  return {{"datagrams", heard()}, {"not understood", not_understood}};
}

}  // namespace kadans::hostmot2
