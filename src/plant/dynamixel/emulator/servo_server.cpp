#include "servo_server.h"

#include <algorithm>
#include <array>
#include <limits>

namespace kadans::dynamixel {

ServoServer::ServoServer(const DynamixelSettings& settings, const PlantSite& site, const std::string& listen)
    : DriveServer(site.layout.period_ns,
                  static_cast<std::uint32_t>(bus_period_ns(settings, site.layout.period_ns) / site.layout.period_ns)),
      listen_(listen),
      robot_(settings, site, site.seed) {
  for (const PortSettings& port : settings.ports)
    terminals_.emplace_back(settings.ports.size() == 1 ? listen : listen + "-" + port.name, "--listen");
}

ServoServer::~ServoServer() { end(); }

std::vector<int> ServoServer::descriptors() const {
  std::vector<int> all;
  for (const PseudoTerminal& one : terminals_) all.push_back(one.descriptor());
  return all;
}

std::int64_t ServoServer::serve_bus(std::int64_t now_ns) noexcept {
  std::array<std::uint8_t, 4096> bytes;
  std::int64_t wake_ns = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < terminals_.size(); ++i) {
    EmulatedBus& bus = robot_.bus(i);
    const std::size_t got = terminals_[i].read(bytes);
    if (got > 0) bus.receive({bytes.data(), got}, now_ns, terminals_[i].baud());
    const std::size_t count = bus.take(bytes, now_ns);
    if (count > 0) terminals_[i].write({bytes.data(), count});
    wake_ns = std::min(wake_ns, bus.due_ns());
  }
  return wake_ns;
}

std::uint64_t ServoServer::heard() const noexcept {
  std::uint64_t heard = 0;
  for (const auto& bus : robot_.buses()) heard += bus->instructions();
  return heard;
}

std::uint64_t ServoServer::cycles() const noexcept {
  std::uint64_t most = 0;
  for (const auto& bus : robot_.buses()) most = std::max(most, bus->sync_reads());
  return most;
}

std::vector<PlantCount> ServoServer::counts() const {
  std::uint64_t not_understood = 0;
  for (const auto& bus : robot_.buses()) not_understood += bus->not_understood();
  return {{"instructions", heard()}, {"not understood", not_understood}};
}

}  // namespace kadans::dynamixel
