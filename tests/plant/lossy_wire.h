// Two ends of a link and what lies between: datagrams are lost, delayed, overtake each other or come twice, as a seed
// says. Nothing happens but in step(): no clock and no network is asked. The ends are sockets of the system, of a kind
// that delivers at once, and holds about ten.
#pragma once

#include <array>
#include <map>
#include <vector>

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "kadans/signal/random.h"
#include "plant/udp/datagram_socket.h"

namespace kadans::test {

struct Weather {
  double loss = 0, twice = 0;                    // shares of the datagrams
  int delay_min_steps = 0, delay_max_steps = 0;  // drawn for each: with a range they overtake each other
};

class LossyWire {
 public:
  explicit LossyWire(std::uint64_t seed) : random_(seed, "wire") {
    for (auto& pair : pairs_) REQUIRE(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0, pair.data()) == 0);
  }
  ~LossyWire() {
    for (const auto& pair : pairs_) close(pair[1]);
  }
  LossyWire(const LossyWire&) = delete;
  LossyWire& operator=(const LossyWire&) = delete;

  // Each once: the socket owns its end.
  DatagramSocket control_end() { return DatagramSocket(pairs_[0][0]); }
  DatagramSocket plant_end() { return DatagramSocket(pairs_[1][0]); }

  Weather to_plant, to_control;

  void step() {
    take(pairs_[0][1], pairs_[1][1], to_plant);
    take(pairs_[1][1], pairs_[0][1], to_control);
    const auto due = on_the_way_.upper_bound(steps_);
    for (auto it = on_the_way_.begin(); it != due; ++it)
      (void)!send(it->second.to, it->second.bytes.data(), it->second.bytes.size(), MSG_DONTWAIT);  // lost when full
    on_the_way_.erase(on_the_way_.begin(), due);
    ++steps_;
  }

 private:
  struct Letter {
    int to;
    std::vector<std::byte> bytes;
  };

  void take(int from, int to, const Weather& weather) {
    std::array<std::byte, 4096> buffer{};
    for (;;) {
      const ssize_t size = recv(from, buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (size < 0) return;
      const int copies = random_.uniform() < weather.twice ? 2 : 1;
      for (int i = 0; i < copies; ++i) {
        if (random_.uniform() < weather.loss) continue;
        const double delay = random_.uniform(weather.delay_min_steps, weather.delay_max_steps + 0.999);
        on_the_way_.insert({steps_ + static_cast<int>(delay), {to, {buffer.data(), buffer.data() + size}}});
      }
    }
  }

  std::array<std::array<int, 2>, 2> pairs_{};  // ours is the second of each
  RandomStream random_;
  std::multimap<int, Letter> on_the_way_;  // by the step in which they arrive
  int steps_ = 0;
};

}  // namespace kadans::test
