// Where emulated drives meet the model that they move: what its shafts do in the drives' coordinates, and what the
// drives do to them.
//
// One owner, one thread at a time.
#pragma once

#include <vector>

#include "kadans/plant/plant_type.h"
#include "kadans/plant/world.h"

namespace kadans {

// A motor at a share of its full voltage, -1..1: its torque falls with its speed.
JointActuation motor_at_voltage(double share, double stall_Nm, double no_load_rad_s) noexcept;

class DriveShafts {
 public:
  explicit DriveShafts(const PlantSite& site);

  const std::vector<std::string>& drives() const noexcept { return names_; }
  std::size_t place(const std::string& drive) const noexcept;

  // What the model's sensors show now. Velocities are those since the last look.
  void look(WorldRobot& robot);
  const SensorFrame& sensors() const noexcept { return sensors_; }
  double position_rad(std::size_t joint) const noexcept { return sensors_.joints[joint].motor_position_rad; }
  double joint_rad(std::size_t joint) const noexcept { return sensors_.joints[joint].position_rad; }  // behind a spring
  double velocity_rad_s(std::size_t joint) const noexcept { return velocity_rad_s_[joint]; }
  double effort_Nm(std::size_t joint) const noexcept { return sensors_.joints[joint].motor_effort_Nm; }
  void rest() noexcept { last_ns_ = 0; }  // the next look begins anew

  void set(std::size_t joint, const JointActuation& does) noexcept { actuation_.joints[joint] = does; }
  void set_brake(std::size_t joint, bool open) noexcept;
  void drive(WorldRobot& robot);

 private:
  std::vector<Transmission> transmissions_;
  std::vector<std::string> names_;  // of the drives, in their joints' places
  SensorFrame sensors_;
  ActuationFrame actuation_;
  std::vector<double> last_rad_, velocity_rad_s_;
  std::int64_t last_ns_ = 0;
};

}  // namespace kadans
