#include "drive_samples.h"

namespace kadans {

void drives_to_joints(std::span<const Transmission> transmissions, SensorFrame& sensors) noexcept {
  for (const Transmission& transmission : transmissions) {
    const std::vector<std::size_t>& joints = transmission.joints();
    JointSample &first = sensors.joints[joints[0]], &second = sensors.joints[joints[transmission.coupled() ? 1 : 0]];
    transmission.to_joints(sensors);
    first.position_rad = first.motor_position_rad;
    second.position_rad = second.motor_position_rad;
    first.time_ns = second.time_ns = std::min(first.time_ns, second.time_ns);
    first.sequence = second.sequence = std::min(first.sequence, second.sequence);
  }
}

}  // namespace kadans
