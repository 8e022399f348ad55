#include <random>

#include "kadans/plant/plant_type.h"
#include "plant_server.h"
#include "signal/input_file.h"
#include "udp_plant.h"
#include "udp_world.h"

namespace kadans {
namespace {

class UdpType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "udp"; }
  std::string_view doc() const noexcept override { return "a plant on another machine"; }

  bool has_fields() const noexcept override { return true; }
  void fields(PlantFields& f) override {
    f.string("peer", settings_.peer, "HOST:PORT of the machine that serves the plant");
    f.number("connect_timeout_s", settings_.connect_timeout_s, {0.1, 600, "s"}, "time to wait for its first answer");
    f.number("round_trip_max_s", settings_.round_trip_max_s, {1e-4, 1, "s"},
             "age of the actuation that a reading answers, above which the reading is not new");
    f.number("watchdog_s", settings_.watchdog_s, {1e-3, 10, "s"},
             "time without actuation after which the plant damps its joints");
    f.number("peer_timeout_s", settings_.peer_timeout_s, {0.1, 600, "s"},
             "time of silence after which the plant is free for another peer");
  }

  std::unique_ptr<Plant> make_plant(const PlantSite& site) const override {
    UdpSettings settings = settings_;
    if (!site.peer.empty()) settings.peer = site.peer;
    if (settings.peer.empty()) {
      refuse(site.file, "says no plant.udp.peer: name the machine that serves the plant with --peer HOST:PORT");
    }
    std::random_device random;
    const std::uint64_t session = (std::uint64_t{random()} << 32U) | random();
    return std::make_unique<UdpPlant>(settings, site.layout, DatagramSocket(connected_socket(settings.peer)), session);
  }

  bool has_imu() const noexcept override { return true; }
  bool is_protocol() const noexcept override { return true; }
  std::unique_ptr<PlantEmulator> make_emulator(const PlantSite& site, const std::string& listen) const override {
    UdpSettings settings = settings_;
    settings.damping_Nms_per_rad = site.damping_Nms_per_rad;
    return std::make_unique<PlantServer>(settings, site.layout, DatagramSocket(listening_socket(listen)));
  }
  bool has_wired_world() const noexcept override { return true; }
  std::unique_ptr<World> make_wired_world(std::unique_ptr<World> model, const PlantSite& site,
                                          const std::vector<EmulatedFault>& faults) const override {
    auto world = std::make_unique<UdpWorld>(std::move(model), settings_, site.layout);
    world->plan_faults(faults);
    return world;
  }

 private:
  UdpSettings settings_;
};

}  // namespace

std::unique_ptr<PlantType> make_udp_type() { return std::make_unique<UdpType>(); }

}  // namespace kadans
