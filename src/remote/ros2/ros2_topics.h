// Translates a robot's row of signals into joints, frames and IMU values: positions, velocities and efforts of the
// joints, the pose of the base in the world, and the pose of each frame of the URDF in its parent frame.
//
// The position and heading of the base are the true ones when the plant is a model. Otherwise heading and height are
// the estimate, and x and y are 0. Roll, pitch and the rates are always the estimate. The acceleration is the IMU's
// measurement.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dds_domain.h"
#include "kadans/control/catalog.h"
#include "kadans/model/urdf_frames.h"
#include "messages.h"  // made by idlc from messages.idl
#include "remote/instance/latest_row.h"

namespace kadans {

class RobotReadings {
 public:
  // Make it when all signals are declared. The catalog must outlive it. Throws InputError on a wrong URDF.
  RobotReadings(const Catalog& catalog, const std::string& urdf);

  void take(const LatestRow::View& row) noexcept;

  std::int64_t time_ns() const noexcept { return time_ns_; }  // time since the run began
  const std::vector<std::string>& joints() const noexcept { return joints_; }
  const std::vector<double>& position_rad() const noexcept { return position_rad_; }
  const std::vector<double>& velocity_rad_s() const noexcept { return velocity_rad_s_; }
  const std::vector<double>& effort_Nm() const noexcept { return effort_Nm_; }
  const Quat& orientation() const noexcept { return orientation_; }
  const Vec3& angular_velocity_rad_s() const noexcept { return angular_velocity_rad_s_; }

  // Along the base's axes, gravity included. It is not known before the first reading of an IMU.
  const Vec3& acceleration_m_s2() const noexcept { return acceleration_m_s2_; }
  bool acceleration_known() const noexcept { return acceleration_m_s2_ != Vec3{}; }

  struct Frame {
    std::string parent, child;
    Pose pose;
  };
  // moving: first the base in "world", then all frames that joints move. fixed: the frames that do not move in their
  // parent.
  const std::vector<Frame>& moving() const noexcept { return moving_; }
  const std::vector<Frame>& fixed() const noexcept { return fixed_; }
  const std::string& base() const noexcept { return moving_.front().child; }

 private:
  using Signal = std::optional<SignalId>;

  const RobotModel& model_;
  std::vector<Signal> position_, velocity_, effort_;
  Signal roll_, pitch_, yaw_, x_, y_, height_, heading_;
  std::array<Signal, 3> rate_, acceleration_;

  std::int64_t time_ns_ = 0;
  std::vector<std::string> joints_;
  std::vector<double> position_rad_, velocity_rad_s_, effort_Nm_;
  Quat orientation_{1, 0, 0, 0};
  Vec3 angular_velocity_rad_s_{}, acceleration_m_s2_{};
  std::vector<UrdfFrame> driven_;  // the frames of moving_ without the base
  std::vector<Frame> moving_, fixed_;
};

// The topics of the bridge in its DDS domain: those of ROS 2 that show the robot, and those of its commands. One thread
// at a time.
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
