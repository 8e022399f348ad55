// The topics of the bridge in its DDS domain: those of ROS 2 that show the robot, and those of its commands. One thread
// at a time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dds_domain.h"
#include "messages.h"  // made by idlc from messages.idl
#include "robot_readings.h"

namespace kadans {

class Ros2Topics {
 public:
  // Publishes what never changes: the description and the fixed frames. `robot` must outlive this object. Throws
  // InputError.
  Ros2Topics(std::uint32_t domain, const RobotReadings& robot, const std::string& urdf);

  // Publishes joint states, frames, IMU and clock with the robot's current readings.
  void publish() noexcept;

  // Takes the next text on /kadans/command; false: none is waiting.
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
  std::vector<Stamped> stamped_;  // scratch: the frames of one message
};

}  // namespace kadans
