#include "kadans/plant/drive_shafts.h"

#include <algorithm>

namespace kadans {

JointActuation motor_at_voltage(double share, double stall_Nm, double no_load_rad_s) noexcept {
  return {
      .effort_Nm = share * stall_Nm, .damping_Nms_per_rad = stall_Nm / no_load_rad_s, .mode = ActuationMode::impedance};
}

DriveShafts::DriveShafts(const PlantSite& site)
    : transmissions_(site.transmissions),
      names_(drive_names(site.layout.joints, site.transmissions)),
      last_rad_(names_.size()),
      velocity_rad_s_(names_.size()) {}

std::size_t DriveShafts::place(const std::string& drive) const noexcept {
  return static_cast<std::size_t>(std::ranges::find(names_, drive) - names_.begin());
}

void DriveShafts::look(WorldRobot& robot) {
  robot.read(sensors_);
  for (const Transmission& transmission : transmissions_) transmission.to_drives(sensors_, Transmission::Side::both);
  const double dt_s = seconds_between(last_ns_, sensors_.time_ns);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    velocity_rad_s_[i] = dt_s > 0 ? (position_rad(i) - last_rad_[i]) / dt_s : 0;
    last_rad_[i] = position_rad(i);
  }
  last_ns_ = sensors_.time_ns;
}

void DriveShafts::set_brake(std::size_t joint, bool open) noexcept {
  DriveRequest& request = actuation_.drives[joint];
  const DriveOrder wanted = open ? DriveOrder::release : DriveOrder::brake;
  if (request.order == wanted) return;
  request = {.order = wanted, .number = static_cast<std::uint8_t>(request.number + 1)};
}

void DriveShafts::drive(WorldRobot& robot) {
  actuation_.joint_count = sensors_.joint_count;
  robot.write_drives(actuation_);
}

}  // namespace kadans
