#include <algorithm>
#include <cmath>

#include "emulator/board_server.h"
#include "emulator/board_world.h"
#include "hostmot2_plant.h"
#include "lbp_link.h"
#include "mapped_link.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

class HostMot2EthernetType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "hm2-eth"; }
  std::string_view doc() const noexcept override { return "Mesa boards with HostMot2 on Ethernet or PCI"; }
  bool has_fields() const noexcept override { return true; }
  void fields(PlantFields& f) override { settings_.fields(f); }

  std::unique_ptr<Plant> make_plant(const PlantSite& site) const override {
    const hostmot2::HostMot2Settings settings = settings_at(site, "--peer", site.peer);
    std::vector<std::unique_ptr<hostmot2::BoardLink>> links;
    for (const hostmot2::BoardSettings& board : settings.boards) {
      if (!board.resource.empty()) {
        links.push_back(std::make_unique<hostmot2::MappedLink>(board.resource));
        continue;
      }
      auto port = std::make_unique<hostmot2::UdpPort>(board);
      links.push_back(std::make_unique<hostmot2::LbpLink>(std::move(port), std::llround(1e9 * settings.patience_s),
                                                          std::llround(1e9 * settings.reply_wait_s)));
    }
    return std::make_unique<hostmot2::HostMot2Plant>(settings, site, std::move(links));
  }
  bool is_protocol() const noexcept override { return true; }
  std::unique_ptr<PlantEmulator> make_emulator(const PlantSite& site, const std::string& listen) const override {
    return std::make_unique<hostmot2::BoardServer>(settings_at(site, "--listen", listen), site);
  }
  bool has_wired_world() const noexcept override { return true; }
  std::unique_ptr<World> make_wired_world(std::unique_ptr<World> model, const PlantSite& site,
                                          const std::vector<EmulatedFault>& faults) const override {
    const hostmot2::HostMot2Settings settings = settings_at(site, "", "");
    settings.require_ethernet();
    auto world = std::make_unique<hostmot2::BoardWorld>(std::move(model), settings, settings, site);
    world->plan_faults(faults);
    return world;
  }
  std::vector<Finding> examine(const PlantSite& site) const override {
    return settings_.boards.empty() ? std::vector<Finding>()
                                    : hostmot2::examine_boards(settings_, site.layout.period_ns);
  }
  const DriveWiringFields* wiring() const override {
    static const DriveWiringFields fields{.section = "drives",
                                          .both = {"board"},
                                          .motor = {"pwm", "output", "enable", "brake", "fault"},
                                          .encoder = {"encoder", "low", "high", "home_switch"},
                                          .motor_reversed = "pwm_reversed",
                                          .encoder_reversed = "reversed",
                                          .home = "home",
                                          .zero = "home_rad"};
    return &fields;
  }
  DriveConstants constants_of(std::string_view drive) const override {
    using Kind = hostmot2::AmplifierSettings::Kind;
    const auto found = std::ranges::find(settings_.drives, drive, &hostmot2::DriveWiring::drive);
    if (found == settings_.drives.end() || !found->pwm) return {};
    const hostmot2::AmplifierSettings& is = found->amplifier;
    DriveConstants all{.scale = {"amplifier_full", is.full}};
    if (is.kind == Kind::voltage) all.scale = {"Nm_per_A", is.Nm_per_A};
    if (is.kind == Kind::velocity) return all;  // its loops are its own
    all.stiffness = {"position_gain_Nm_per_rad", found->position_gain_Nm_per_rad};
    all.damping = {"velocity_gain_Nms_per_rad", found->velocity_gain_Nms_per_rad};
    return all;
  }
  DriveWords drive_words() const noexcept override { return hostmot2::drive_code_words; }

 private:
  // The configuration's, with the boards at addresses that the command line names.
  hostmot2::HostMot2Settings settings_at(const PlantSite& site, const char* option, const std::string& address) const {
    hostmot2::HostMot2Settings settings = settings_;
    if (settings.drives.empty())
      refuse(site.file, "says no plant.hm2-eth.drives: which modules move which joint (docs/hostmot2.md)");
    try {
      if (!address.empty()) settings.move_boards(address);
    } catch (const InputError& error) {
      refuse(option, error.problems().front().message);
    }
    return settings;
  }

  hostmot2::HostMot2Settings settings_;
};

}  // namespace

std::unique_ptr<PlantType> make_hostmot2_type() { return std::make_unique<HostMot2EthernetType>(); }

}  // namespace kadans
