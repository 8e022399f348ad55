// The network between the robots of one simulation, on virtual time: what one sends comes to each other one after a
// delay, or is lost. The random numbers are one stream of the run's seed.
//
// One thread, that of lockstep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "kadans/signal/random.h"
#include "message_channel.h"

namespace kadans {

class SimulatedNetwork {
 public:
  static constexpr std::size_t under_way_max = 256;  // to one robot; more are lost

  SimulatedNetwork(const ScenarioNetwork& settings, std::size_t robots, std::uint64_t seed);

  // The network outlives its ports.
  MessageChannel& port(std::size_t robot) noexcept { return ports_[robot]; }

 private:
  struct Datagram {
    std::int64_t due_ns = 0;
    std::string bytes;
  };
  class Port final : public MessageChannel {
   public:
    Port(SimulatedNetwork& network, std::size_t robot) noexcept : network_(&network), robot_(robot) {}
    bool receive(std::int64_t now_ns, std::string_view& datagram, std::int64_t& came_ns) noexcept override;
    bool send(std::int64_t now_ns, std::string_view datagram) noexcept override;
    std::deque<Datagram> coming;

   private:
    SimulatedNetwork* network_;
    std::size_t robot_;
    std::string received_;
  };

  void carry(std::size_t from, std::int64_t now_ns, std::string_view datagram);

  ScenarioNetwork settings_;
  RandomStream random_;
  std::deque<Port> ports_;
};

}  // namespace kadans
