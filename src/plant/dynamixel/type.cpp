#include <algorithm>

#include "dynamixel_plant.h"
#include "emulator/servo_server.h"
#include "emulator/servo_world.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

class DynamixelType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "dynamixel"; }
  std::string_view doc() const noexcept override { return "Dynamixel servos on serial ports, protocol 2.0"; }
  bool has_fields() const noexcept override { return true; }
  void fields(PlantFields& f) override { settings_.fields(f); }

  std::unique_ptr<Plant> make_plant(const PlantSite& site) const override {
    return std::make_unique<dynamixel::DynamixelPlant>(settings_at(site, site.peer), site,
                                                       std::vector<std::unique_ptr<SerialPort>>(),
                                                       dynamixel::DynamixelPlant::Threads::own);
  }
  bool is_protocol() const noexcept override { return true; }
  std::unique_ptr<PlantEmulator> make_emulator(const PlantSite& site, const std::string& listen) const override {
    return std::make_unique<dynamixel::ServoServer>(settings_at(site, ""), site, listen);
  }
  bool has_wired_world() const noexcept override { return true; }
  std::unique_ptr<World> make_wired_world(std::unique_ptr<World> model, const PlantSite& site,
                                          const std::vector<EmulatedFault>& faults) const override {
    auto world = std::make_unique<dynamixel::ServoWorld>(std::move(model), settings_at(site, ""), site);
    world->plan_faults(faults);
    return world;
  }
  std::vector<Finding> examine(const PlantSite& site) const override {
    return settings_.servos.empty() ? std::vector<Finding>()
                                    : dynamixel::examine_ports(settings_, site.layout.period_ns);
  }
  const DriveWiringFields* wiring() const override {
    static const DriveWiringFields fields{.section = "servos",
                                          .both = {"port", "id", "model"},
                                          .motor_reversed = "reversed",
                                          .encoder_reversed = "reversed",
                                          .zero = "zero_pulse",
                                          .zero_default = static_cast<double>(dynamixel::ServoSettings{}.zero_pulse),
                                          .zero_unit_rad = dynamixel::rad_per_pulse,
                                          .zero_turn = dynamixel::pulses_per_turn};
    return &fields;
  }
  DriveConstants constants_of(std::string_view drive) const override {
    const auto found = std::ranges::find(settings_.servos, drive, &dynamixel::ServoSettings::drive);
    if (found == settings_.servos.end() || !found->model->has_current()) return {};
    return {.scale = {"Nm_per_A", found->torque_constant_Nm_per_A()}};
  }
  DriveWords drive_words() const noexcept override { return dynamixel::drive_code_words; }

 private:
  // The configuration's, with the device that the command line names.
  dynamixel::DynamixelSettings settings_at(const PlantSite& site, const std::string& device) const {
    dynamixel::DynamixelSettings settings = settings_;
    if (settings.servos.empty())
      refuse(site.file, "says no plant.dynamixel.servos: which servo moves which joint (docs/dynamixel.md)");
    if (!device.empty() && settings.ports.size() > 1)
      refuse("--peer", "the robot has several serial ports: write their devices in " + site.file);
    if (!device.empty()) {
      settings.ports.front().device = device;
      settings.ports.front().place = {.file = "--peer"};
    }
    return settings;
  }

  dynamixel::DynamixelSettings settings_;
};

}  // namespace

std::unique_ptr<PlantType> make_dynamixel_type() { return std::make_unique<DynamixelType>(); }

}  // namespace kadans
