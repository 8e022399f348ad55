#include "simulated_network.h"

#include <algorithm>
#include <cmath>

namespace kadans {

SimulatedNetwork::SimulatedNetwork(const ScenarioNetwork& settings, std::size_t robots, std::uint64_t seed)
    : settings_(settings), random_(seed, "network") {
  for (std::size_t i = 0; i < robots; ++i) ports_.emplace_back(*this, i);
}

// Always as many numbers, so that nothing that is lost shifts what follows. Each way has its own order.
void SimulatedNetwork::carry(std::size_t from, std::int64_t now_ns, std::string_view datagram) {
  for (std::size_t to = 0; to < ports_.size(); ++to) {
    if (to == from) continue;
    const double lost = random_.uniform(), late = random_.uniform();
    std::deque<Datagram>& coming = ports_[to].coming;
    if (lost < settings_.lost || coming.size() >= under_way_max) continue;
    const std::int64_t due_ns = now_ns + std::llround(1e9 * (settings_.delay_s + late * settings_.jitter_s));
    const auto later = std::ranges::upper_bound(coming, due_ns, {}, &Datagram::due_ns);
    coming.insert(later, {due_ns, std::string(datagram)});
  }
}

bool SimulatedNetwork::Port::receive(std::int64_t now_ns, std::string_view& datagram, std::int64_t& came_ns) noexcept {
  if (coming.empty() || coming.front().due_ns > now_ns) return false;
  came_ns = coming.front().due_ns;
  received_ = std::move(coming.front().bytes);
  coming.pop_front();
  datagram = received_;
  return true;
}

bool SimulatedNetwork::Port::send(std::int64_t now_ns, std::string_view datagram) noexcept {
  network_->carry(robot_, now_ns, datagram);
  return true;
}

}  // namespace kadans
