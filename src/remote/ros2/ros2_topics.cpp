
#include "ros2_topics.h"

#include <algorithm>
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

namespace {

constexpr DdsQuality kept_for_all{.depth = 1, .for_late_readers = true};
constexpr std::int32_t frames_depth = 100, commands_depth = 16;  // tf2's own; orders that may wait

// A sample that is written is only read: the C structs know no const.
char* chars(const std::string& text) noexcept { return const_cast<char*>(text.c_str()); }

template <typename Sequence, typename Value>
Sequence sequence_of(const std::vector<Value>& values) noexcept {
  const auto count = static_cast<std::uint32_t>(values.size());
  return {._maximum = count, ._length = count, ._buffer = const_cast<Value*>(values.data()), ._release = false};
}

geometry_msgs_msg_dds__Vector3_ vector(const Vec3& v) noexcept { return {.x = v[0], .y = v[1], .z = v[2]}; }
geometry_msgs_msg_dds__Quaternion_ quaternion(const Quat& q) noexcept {
  return {.x = q[1], .y = q[2], .z = q[3], .w = q[0]};
}

}  // namespace

Ros2Topics::Ros2Topics(std::uint32_t domain, const RobotReadings& robot, const std::string& urdf)
    : robot_(robot),
      domain_(domain),
      to_{.joint_states = domain_.writer(sensor_msgs_msg_dds__JointState__desc, "rt/joint_states"),
          .tf = domain_.writer(tf2_msgs_msg_dds__TFMessage__desc, "rt/tf", {.depth = frames_depth}),
          .tf_static = domain_.writer(tf2_msgs_msg_dds__TFMessage__desc, "rt/tf_static", kept_for_all),
          .description = domain_.writer(std_msgs_msg_dds__String__desc, "rt/robot_description", kept_for_all),
          .imu = domain_.writer(sensor_msgs_msg_dds__Imu__desc, "rt/imu"),
          .clock = domain_.writer(rosgraph_msgs_msg_dds__Clock__desc, "rt/clock"),
          .command_result =
              domain_.writer(std_msgs_msg_dds__String__desc, "rt/kadans/command_result", {.depth = commands_depth})},
      commands_(domain_.reader(std_msgs_msg_dds__String__desc, "rt/kadans/command", {.depth = commands_depth})) {
  for (const std::string& name : robot_.joints()) names_.push_back(chars(name));
  stamped_.resize(std::max(robot_.moving().size(), robot_.fixed().size()));
  publish_text(to_.description, urdf);
  if (!robot_.fixed().empty()) publish_frames(to_.tf_static, robot_.fixed(), {});
}

void Ros2Topics::publish() noexcept {
  const Stamp now{.sec = static_cast<std::int32_t>(robot_.time_ns() / ns_per_s),
                  .nanosec = static_cast<std::uint32_t>(robot_.time_ns() % ns_per_s)};
  const rosgraph_msgs_msg_dds__Clock_ clock{.clock_time = now};
  (void)domain_.write(to_.clock, &clock);
  publish_frames(to_.tf, robot_.moving(), now);
  publish_joint_states(now);
  publish_imu(now);
}

void Ros2Topics::publish_joint_states(Stamp now) noexcept {
  sensor_msgs_msg_dds__JointState_ message{};
  message.header.stamp = now;
  message.header.frame_id = chars(robot_.base());
  message.name = sequence_of<decltype(message.name)>(names_);
  message.position = sequence_of<decltype(message.position)>(robot_.position_rad());
  message.velocity = sequence_of<decltype(message.velocity)>(robot_.velocity_rad_s());
  message.effort = sequence_of<decltype(message.effort)>(robot_.effort_Nm());
  (void)domain_.write(to_.joint_states, &message);
}

void Ros2Topics::publish_frames(dds_entity_t writer, const std::vector<RobotReadings::Frame>& frames,
                                Stamp now) noexcept {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RobotReadings::Frame& frame = frames[i];
    stamped_[i] = {
        .header = {.stamp = now, .frame_id = chars(frame.parent)},
        .child_frame_id = chars(frame.child),
        .transform = {.translation = vector(frame.pose.position_m), .rotation = quaternion(frame.pose.orientation)}};
  }
  tf2_msgs_msg_dds__TFMessage_ message{};
  message.transforms = sequence_of<decltype(message.transforms)>(stamped_);
  message.transforms._length = static_cast<std::uint32_t>(frames.size());
  (void)domain_.write(writer, &message);
}

// How exact it is nobody knows: all 0. -1: nothing was measured.
void Ros2Topics::publish_imu(Stamp now) noexcept {
  sensor_msgs_msg_dds__Imu_ message{};
  message.header = {.stamp = now, .frame_id = chars(robot_.base())};
  message.orientation = quaternion(robot_.orientation());
  message.angular_velocity = vector(robot_.angular_velocity_rad_s());
  message.linear_acceleration = vector(robot_.acceleration_m_s2());
  if (!robot_.acceleration_known()) message.linear_acceleration_covariance[0] = -1;
  (void)domain_.write(to_.imu, &message);
}

void Ros2Topics::publish_text(dds_entity_t writer, const std::string& text) noexcept {
  const std_msgs_msg_dds__String_ message{.data = chars(text)};
  (void)domain_.write(writer, &message);
}

bool Ros2Topics::take(std::string& command) {
  command.clear();
  return domain_.take<std_msgs_msg_dds__String_>(commands_, [&](const std_msgs_msg_dds__String_& message) {
    if (message.data != nullptr) command = message.data;
  });
}

void Ros2Topics::answer(const std::string& text) noexcept { publish_text(to_.command_result, text); }

}  // namespace kadans
