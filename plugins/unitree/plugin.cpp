// The plant "unitree" as a plug-in: docs/unitree.md.
#include "kadans/control/plugin.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include "kadans/plant/plant_type.h"
#include "unitree_emulator.h"
#include "unitree_world.h"

namespace unitree {
namespace {

// The network card's address in the Internet; "": it has none, or is not up.
std::string address_of(const std::string& card) {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return "";
  std::string found;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (card != one->ifa_name || one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    if ((one->ifa_flags & (IFF_UP | IFF_RUNNING)) != (IFF_UP | IFF_RUNNING)) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* const address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr) found = text.data();
  }
  freeifaddrs(all);
  return found;
}

class UnitreeType final : public kadans::PlantType {
 public:
  std::string_view name() const noexcept override { return "unitree"; }
  std::string_view doc() const noexcept override { return "a robot of Unitree's at its low level, over DDS"; }
  bool has_fields() const noexcept override { return true; }
  void fields(kadans::PlantFields& f) override { settings_.fields(f); }

  std::unique_ptr<kadans::Plant> make_plant(const kadans::PlantSite& site) const override {
    Settings settings = settings_;
    settings.take_place(site.peer, "--peer");
    return std::make_unique<UnitreePlant>(settings, site);
  }
  bool has_imu() const noexcept override { return true; }
  bool is_protocol() const noexcept override { return true; }
  std::unique_ptr<kadans::PlantEmulator> make_emulator(const kadans::PlantSite& site,
                                                       const std::string& listen) const override {
    Settings settings = settings_;
    settings.take_place(listen, "--listen");
    return std::make_unique<UnitreeEmulator>(settings, site);
  }
  bool has_wired_world() const noexcept override { return true; }
  std::unique_ptr<kadans::World> make_wired_world(std::unique_ptr<kadans::World> model, const kadans::PlantSite& site,
                                                  const std::vector<kadans::EmulatedFault>& faults) const override {
    auto world = std::make_unique<UnitreeWorld>(std::move(model), settings_, site);
    world->plan_faults(faults);
    return world;
  }
  std::vector<Finding> examine(const kadans::PlantSite&) const override {
    if (settings_.kind == nullptr || settings_.interface.empty()) return {};
    const std::string address = address_of(settings_.interface);
    return {{.topic = "network card " + settings_.interface,
             .good = !address.empty(),
             .is = address.empty() ? "is not up, or has no address" : "has the address " + address,
             .should = "up, with an address in the robot's network, such as 192.168.123.99",
             .how = "ip addr add 192.168.123.99/24 dev " + settings_.interface}};
  }
  kadans::DriveWords drive_words() const noexcept override { return drive_code_words; }

 private:
  Settings settings_;
};

}  // namespace

std::unique_ptr<kadans::PlantType> make_unitree_type() { return std::make_unique<UnitreeType>(); }

}  // namespace unitree

KADANS_PLUGIN(kadans::plugin_type<unitree::make_unitree_type>())
