// What the bridge has in its DDS domain: the topics of ROS 2 that a robot is seen by, and those of its commands.
// One thread at a time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dds_domain.h"
#include "kadans/remote/ros2/robot_readings.h"
#include "messages.h"  // made by idlc from messages.idl

namespace kadans {

class Ros2Topics {
 public:
  // Publishes what does not change: the description, the fixed frames. `robot` must outlive it. Throws InputError.
  Ros2Topics(std::uint32_t domain, const RobotReadings& robot, const std::string& urdf);

  // Joint states, frames, IMU and clock, as the robot's readings are now.
  void publish() noexcept;

  // The next text on /kadans/command; false: none waits.
  [[nodiscard]] bool take(std::string& command);
  void answer(const std::string& text) noexcept;

 private:
  using Stamp = builtin_interfaces_msg_dds__Time_;
  using Stamped = geometry_msgs_msg_dds__TransformStamped_;
  struct Writers {
    dds_entity_t joint_states, tf, tf_static, description, imu, clock, command_result;
  };

  void publish_joint_states(Stamp now) noexcept;
  void publish_frames(dds_entity_t writer, const std::vector<RobotReadings::Frame>& frames, Stamp now) noexcept;
  void publish_imu(Stamp now) noexcept;
  void publish_text(dds_entity_t writer, const std::string& text) noexcept;

  const RobotReadings& robot_;
  DdsDomain domain_;
  Writers to_;
  dds_entity_t commands_;
  std::vector<char*> names_;      // of the joints
  std::vector<Stamped> stamped_;  // as many as are moving, or fixed
};

}  // namespace kadans
