// What a robot's row of signals says to somebody who knows joints, frames and an IMU, but no signals: positions,
// velocities and efforts by joint, the pose of the base in the world, each frame of the URDF in its parent's.
//
// The base is where the model has it, where there is a model, else where it is estimated: heading and height, at the
// origin. Roll and pitch, and the IMU, are always the estimate.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/model/urdf_frames.h"
#include "kadans/remote/latest_row.h"

namespace kadans {

class RobotReadings {
 public:
  // When all signals are declared; the catalog must outlive it. Throws InputError on a wrong URDF.
  RobotReadings(const Catalog& catalog, const std::string& urdf);

  void take(const LatestRow::View& row) noexcept;

  std::int64_t time_ns() const noexcept { return time_ns_; }  // since the run began
  const std::vector<std::string>& joints() const noexcept { return joints_; }
  const std::vector<double>& position_rad() const noexcept { return position_rad_; }
  const std::vector<double>& velocity_rad_s() const noexcept { return velocity_rad_s_; }
  const std::vector<double>& effort_Nm() const noexcept { return effort_Nm_; }
  const Quat& orientation() const noexcept { return orientation_; }
  const Vec3& angular_velocity_rad_s() const noexcept { return angular_velocity_rad_s_; }

  struct Frame {
    std::string parent, child;
    Pose pose;
  };
  // "world" to the base, then all that joints move; and what stays where it is.
  const std::vector<Frame>& moving() const noexcept { return moving_; }
  const std::vector<Frame>& fixed() const noexcept { return fixed_; }
  const std::string& base() const noexcept { return moving_.front().child; }

 private:
  using Signal = std::optional<SignalId>;

  const RobotModel& model_;
  std::vector<Signal> position_, velocity_, effort_;
  Signal roll_, pitch_, yaw_, x_, y_, height_, heading_;
  std::array<Signal, 3> rate_;

  std::int64_t time_ns_ = 0;
  std::vector<std::string> joints_;
  std::vector<double> position_rad_, velocity_rad_s_, effort_Nm_;
  Quat orientation_{1, 0, 0, 0};
  Vec3 angular_velocity_rad_s_{};
  std::vector<UrdfFrame> driven_;  // of moving_, without the base
  std::vector<Frame> moving_, fixed_;
};

}  // namespace kadans
