#include "udp_world.h"

#include <array>
#include <utility>

#include <sys/socket.h>

#include "signal/input_file.h"

namespace kadans {

UdpWorld::Ends::Ends() {
  std::array<int, 2> pair{};
  if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, pair.data()) != 0) refuse("the system gives no sockets");
  control = pair[0];
  plant = pair[1];
}

UdpWorld::UdpWorld(std::unique_ptr<World> model, const UdpSettings& settings, const PlantLayout& layout)
    : UdpWorld(std::move(model), settings, layout, Ends()) {}

UdpWorld::UdpWorld(std::unique_ptr<World> model, UdpSettings settings, const PlantLayout& layout, Ends ends)
    : WorldAround(std::move(model)),
      server_(settings, layout, DatagramSocket(ends.plant)),
      plant_(settings, layout, DatagramSocket(ends.control), 1) {}

bool UdpWorld::open(bool (*)() noexcept) {
  const bool there = plant_.greet() && server_.await(0) && server_.beat(world_, 1) && plant_.welcomed();
  if (!there) refuse("both ends of the plant's socket do not find each other");
  return true;
}

}  // namespace kadans
