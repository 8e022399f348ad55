#include "robot_readings.h"

#include <utility>

#include "kadans/model/kinematics.h"

namespace kadans {

RobotReadings::RobotReadings(const Catalog& catalog, const std::string& urdf) : model_(*catalog.model) {
  const auto find = [&](const std::string& name) { return catalog.signals.find(name); };
  const auto first = [&](const char* one, const char* other) { return find(one) ? find(one) : find(other); };
  for (const Joint& joint : model_.joints) {
    joints_.push_back(joint.name);
    position_.push_back(find("joint." + joint.name + ".position_rad"));
    velocity_.push_back(find("joint." + joint.name + ".velocity_rad_s"));
    effort_.push_back(find("joint." + joint.name + ".effort_Nm"));
  }
  for (std::vector<double>* values : {&position_rad_, &velocity_rad_s_, &effort_Nm_}) values->resize(joints_.size());
  roll_ = find("base.roll_rad"), pitch_ = find("base.pitch_rad"), yaw_ = find("base.yaw_rad");
  heading_ = first("plant.base.yaw_rad", "base.yaw_rad");
  x_ = find("plant.base.x_m"), y_ = find("plant.base.y_m"), height_ = first("plant.base.height_m", "base.height_m");
  rate_ = {find("base.rate_x_rad_s"), find("base.rate_y_rad_s"), find("base.rate_z_rad_s")};
  acceleration_ = {find("imu.acceleration_x_m_s2"), find("imu.acceleration_y_m_s2"), find("imu.acceleration_z_m_s2")};
  moving_.push_back({"world", model_.links.front().name, {}});
  for (UrdfFrame& frame : urdf_frames(model_, urdf)) {
    (frame.joint ? moving_ : fixed_).push_back({frame.parent, frame.child, frame.origin});
    if (frame.joint) driven_.push_back(std::move(frame));
  }
}

void RobotReadings::take(const LatestRow::View& row) noexcept {
  const auto value = [&](const Signal& signal) { return signal ? row.values[*signal] : 0.0; };
  time_ns_ = row.time_ns;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    position_rad_[i] = value(position_[i]);
    velocity_rad_s_[i] = value(velocity_[i]);
    effort_Nm_[i] = value(effort_[i]);
  }
  for (std::size_t i = 0; i < rate_.size(); ++i) {
    angular_velocity_rad_s_[i] = value(rate_[i]);
    acceleration_m_s2_[i] = value(acceleration_[i]);
  }
  orientation_ = from_roll_pitch_yaw(value(roll_), value(pitch_), value(yaw_));
  moving_[0].pose = {{value(x_), value(y_), value(height_)},
                     from_roll_pitch_yaw(value(roll_), value(pitch_), value(heading_))};
  for (std::size_t i = 0; i < driven_.size(); ++i) moving_[i + 1].pose = frame_pose(driven_[i], model_, position_rad_);
}

}  // namespace kadans
