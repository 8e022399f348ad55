#include "ros2_bridge.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "dds_domain.h"
#include "engine/behavior_log.h"
#include "engine/clock.h"
#include "event_topics.h"
#include "kadans/control/catalog.h"
#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"
#include "messages.h"  // made by idlc from messages.idl
#include "realtime/machine/placement.h"
#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"
#include "remote/instance/latest_row.h"
#include "text_orders.h"

namespace kadans {

// A robot's joints, frames and IMU values: positions, velocities and efforts of the joints, the pose of the base in the
// world, and the pose of each frame of the URDF in its parent frame.
//
// The position and heading of the base are the true ones when the plant is a model. Otherwise they are those of the
// odometry; without feet x and y are 0. Roll, pitch and the rates are always the estimate. The acceleration is the
// IMU's measurement.
struct RobotReadings {
  std::int64_t time_ns = 0;  // time since the run began
  std::vector<std::string> joints;
  std::vector<double> position_rad, velocity_rad_s, effort_Nm;
  Quat orientation{1, 0, 0, 0};
  Vec3 angular_velocity_rad_s{};

  // Along the base's axes, gravity included. It is not known before the first reading of an IMU.
  Vec3 acceleration_m_s2{};
  bool acceleration_known() const noexcept { return acceleration_m_s2 != Vec3{}; }

  // Where the base is by its feet, and its velocity along its own heading; nothing where the odometry is not valid.
  struct Odometry {
    Pose pose;
    Vec3 velocity_m_s{};
  };
  std::optional<Odometry> odometry;

  struct Frame {
    std::string parent, child;
    Pose pose;
  };
  // moving: first the base in "world", then all frames that joints move. fixed: the frames that do not move in their
  // parent.
  std::vector<Frame> moving, fixed;
  const std::string& base() const noexcept { return moving.front().child; }
};

// Translates a row of signals into readings.
class RowReader {
 public:
  // Make it when all signals are declared. The catalog must outlive it. Throws InputError on a wrong URDF.
  RowReader(const Catalog& catalog, const std::string& urdf);

  void take(const LatestRow::View& row) noexcept;
  const RobotReadings& readings() const noexcept { return is_; }

 private:
  using Signal = std::optional<SignalId>;
  struct Place {
    Signal x, y, heading, valid, height;
  };
  void take_odometry(const LatestRow::View& row, double elapsed_s) noexcept;

  const RobotModel& model_;
  RobotReadings is_;
  std::vector<Signal> position_, velocity_, effort_;
  Signal roll_, pitch_, yaw_, x_, y_, height_, heading_;
  std::array<Signal, 3> rate_, acceleration_;
  Place reckoned_;
  std::vector<UrdfFrame> driven_;  // the frames of `moving` without the base
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
  // Or the next event for the behaviors, as a command.
  [[nodiscard]] bool take_event(std::string& command) { return events_.take(command); }
  void listen(const std::vector<BehaviorReport>& behaviors) { events_.listen(behaviors); }
  void answer(const std::string& text) noexcept;
  void tell_active(const std::string& json) noexcept { publish_text(to_.active, json); }

 private:
  using Stamp = builtin_interfaces_msg_dds__Time_;
  using Stamped = geometry_msgs_msg_dds__TransformStamped_;
  struct Writers {
    dds_entity_t joint_states, tf, tf_static, description, imu, clock, active, command_result, odometry;
  };

  void publish_joint_states(Stamp now) noexcept;
  void publish_frames(dds_entity_t writer, const std::vector<RobotReadings::Frame>& frames, Stamp now) noexcept;
  void publish_imu(Stamp now) noexcept;
  void publish_odometry(Stamp now) noexcept;
  void publish_text(dds_entity_t writer, const std::string& text) noexcept;

  const RobotReadings& robot_;
  DdsDomain domain_;
  Writers to_;
  dds_entity_t commands_;
  EventTopics events_{domain_};
  std::vector<char*> names_;      // of the joints
  std::vector<Stamped> stamped_;  // scratch: the frames of one message
};

RowReader::RowReader(const Catalog& catalog, const std::string& urdf) : model_(*catalog.model) {
  const auto find = [&](const std::string& name) { return catalog.signals.find(name); };
  const auto first = [&](const char* one, const char* other) { return find(one) ? find(one) : find(other); };
  for (const Joint& joint : model_.joints) {
    is_.joints.push_back(joint.name);
    position_.push_back(find("joint." + joint.name + ".position_rad"));
    velocity_.push_back(find("joint." + joint.name + ".velocity_rad_s"));
    effort_.push_back(find("joint." + joint.name + ".effort_Nm"));
  }
  for (std::vector<double>* values : {&is_.position_rad, &is_.velocity_rad_s, &is_.effort_Nm})
    values->resize(is_.joints.size());
  roll_ = find("base.roll_rad"), pitch_ = find("base.pitch_rad"), yaw_ = find("base.yaw_rad");
  reckoned_ = {find("odometry.x_m"), find("odometry.y_m"), find("odometry.heading_rad"), find("odometry.valid"),
               find("base.height_m")};
  heading_ = first("plant.base.yaw_rad", reckoned_.x ? "odometry.heading_rad" : "base.yaw_rad");
  x_ = first("plant.base.x_m", "odometry.x_m"), y_ = first("plant.base.y_m", "odometry.y_m");
  height_ = first("plant.base.height_m", "base.height_m");
  rate_ = {find("base.rate_x_rad_s"), find("base.rate_y_rad_s"), find("base.rate_z_rad_s")};
  acceleration_ = {find("imu.acceleration_x_m_s2"), find("imu.acceleration_y_m_s2"), find("imu.acceleration_z_m_s2")};
  is_.moving.push_back({"world", model_.links.front().name, {}});
  for (UrdfFrame& frame : urdf_frames(model_, urdf)) {
    (frame.joint ? is_.moving : is_.fixed).push_back({frame.parent, frame.child, frame.origin});
    if (frame.joint) driven_.push_back(std::move(frame));
  }
}

void RowReader::take(const LatestRow::View& row) noexcept {
  const auto value = [&](const Signal& signal) { return signal ? row.values[*signal] : 0.0; };
  take_odometry(row, 1e-9 * static_cast<double>(row.time_ns - is_.time_ns));
  is_.time_ns = row.time_ns;
  for (std::size_t i = 0; i < is_.joints.size(); ++i) {
    is_.position_rad[i] = value(position_[i]);
    is_.velocity_rad_s[i] = value(velocity_[i]);
    is_.effort_Nm[i] = value(effort_[i]);
  }
  for (std::size_t i = 0; i < rate_.size(); ++i) {
    is_.angular_velocity_rad_s[i] = value(rate_[i]);
    is_.acceleration_m_s2[i] = value(acceleration_[i]);
  }
  is_.orientation = from_roll_pitch_yaw(value(roll_), value(pitch_), value(yaw_));
  is_.moving[0].pose = {{value(x_), value(y_), value(height_)},
                        from_roll_pitch_yaw(value(roll_), value(pitch_), value(heading_))};
  for (std::size_t i = 0; i < driven_.size(); ++i)
    is_.moving[i + 1].pose = frame_pose(driven_[i], model_, is_.position_rad);
}

void RowReader::take_odometry(const LatestRow::View& row, double elapsed_s) noexcept {
  const auto value = [&](const Signal& signal) { return signal ? row.values[*signal] : 0.0; };
  if (value(reckoned_.valid) == 0) return is_.odometry.reset();
  const double heading_rad = value(reckoned_.heading), c = std::cos(heading_rad), s = std::sin(heading_rad);
  const Vec3 at_m{value(reckoned_.x), value(reckoned_.y), value(reckoned_.height)};
  const Pose now{at_m, from_roll_pitch_yaw(value(roll_), value(pitch_), heading_rad)};
  const bool goes_on = is_.odometry && elapsed_s > 0 && !(at_m[0] == 0 && at_m[1] == 0);  // that is a reset
  const Vec3 from_m = goes_on ? is_.odometry->pose.position_m : at_m;
  const double per_s = goes_on ? 1 / elapsed_s : 0, x_m = at_m[0] - from_m[0], y_m = at_m[1] - from_m[1];
  is_.odometry = {now, {per_s * (c * x_m + s * y_m), per_s * (c * y_m - s * x_m), per_s * (at_m[2] - from_m[2])}};
}

namespace {

const std::string odometry_frame = "odom";
constexpr DdsQuality kept_for_all{.depth = 1, .for_late_readers = true};
constexpr std::int32_t frames_depth = 100, commands_depth = 16, active_depth = 32;  // tf2's own; orders that may wait

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
          .active = domain_.writer(std_msgs_msg_dds__String__desc, "rt/kadans/active",
                                   {.depth = active_depth, .for_late_readers = true}),
          .command_result =
              domain_.writer(std_msgs_msg_dds__String__desc, "rt/kadans/command_result", {.depth = commands_depth}),
          .odometry = domain_.writer(nav_msgs_msg_dds__Odometry__desc, "rt/odom")},
      commands_(domain_.reader(std_msgs_msg_dds__String__desc, "rt/kadans/command", {.depth = commands_depth})) {
  for (const std::string& name : robot_.joints) names_.push_back(chars(name));
  stamped_.resize(std::max(robot_.moving.size(), robot_.fixed.size()));
  publish_text(to_.description, urdf);
  if (!robot_.fixed.empty()) publish_frames(to_.tf_static, robot_.fixed, {});
}

void Ros2Topics::publish() noexcept {
  const Stamp now{.sec = static_cast<std::int32_t>(robot_.time_ns / ns_per_s),
                  .nanosec = static_cast<std::uint32_t>(robot_.time_ns % ns_per_s)};
  const rosgraph_msgs_msg_dds__Clock_ clock{.clock_time = now};
  (void)domain_.write(to_.clock, &clock);
  publish_frames(to_.tf, robot_.moving, now);
  publish_joint_states(now);
  publish_imu(now);
  publish_odometry(now);
}

void Ros2Topics::publish_joint_states(Stamp now) noexcept {
  sensor_msgs_msg_dds__JointState_ message{};
  message.header.stamp = now;
  message.header.frame_id = chars(robot_.base());
  message.name = sequence_of<decltype(message.name)>(names_);
  message.position = sequence_of<decltype(message.position)>(robot_.position_rad);
  message.velocity = sequence_of<decltype(message.velocity)>(robot_.velocity_rad_s);
  message.effort = sequence_of<decltype(message.effort)>(robot_.effort_Nm);
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
  message.orientation = quaternion(robot_.orientation);
  message.angular_velocity = vector(robot_.angular_velocity_rad_s);
  message.linear_acceleration = vector(robot_.acceleration_m_s2);
  if (!robot_.acceleration_known()) message.linear_acceleration_covariance[0] = -1;
  (void)domain_.write(to_.imu, &message);
}

void Ros2Topics::publish_odometry(Stamp now) noexcept {
  if (!robot_.odometry) return;
  const auto& [pose, velocity_m_s] = *robot_.odometry;
  nav_msgs_msg_dds__Odometry_ message{};
  message.header = {.stamp = now, .frame_id = chars(odometry_frame)};
  message.child_frame_id = chars(robot_.base());
  message.pose.pose = {.position = vector(pose.position_m), .orientation = quaternion(pose.orientation)};
  message.twist.twist = {.linear = vector(velocity_m_s), .angular = vector(robot_.angular_velocity_rad_s)};
  (void)domain_.write(to_.odometry, &message);
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

namespace {

constexpr int niceness = 5;
constexpr int commands_a_beat = 8;  // the others wait, or make way for newer ones
constexpr int events_a_beat = 64;
constexpr double beats_a_sample = 2;
constexpr double behaviors_asked_s = 0.25;  // how often it is asked which events what plays takes

}  // namespace

// It beats twice as often as rows are asked for, so that whichever way the two clocks drift no row is missed. Its first
// beat joins the domain: the threads that DDS starts are as low as this one, and on the same CPUs.
struct Ros2Bridge::Inside final : Task {
  Inside(const Ros2Settings& wanted, const Parts& parts)
      : settings(wanted),
        port(parts.port),
        urdf(parts.texts.urdf),
        every_ticks(static_cast<std::uint32_t>(
            std::max(1.0, std::round(1 / (wanted.rate_hz * parts.instance.facts().control_period_s))))),
        reader(parts.instance.catalog(), urdf),
        commands({.instance = parts.instance,
                  .port = parts.port,
                  .pace = parts.pace,
                  .allowed = wanted.commands,
                  .refusal = "this run takes no orders over ROS 2: start it with --ros2-commands",
                  .who = "ROS 2"}),
        thread({.name = "ros2", .period_ns = std::llround(1e9 / (beats_a_sample * wanted.rate_hz))}, *this, wait) {}

  bool beat(const Beat&) override {
    if (!topics) return join();
    if (!running.load(std::memory_order_acquire)) return true;
    const auto row = port.signals();
    if (!row->values.empty() && row->tick != last_tick) {
      last_tick = row->tick;
      reader.take(*row);
      topics->publish();
    }
    serve();
    return true;
  }

  bool join() {
    try {
      (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);  // of this thread, and those it starts
      if (settings.avoid_cpu >= 0) (void)leave_cpu(settings.avoid_cpu);
      topics.emplace(settings.domain, reader.readings(), urdf);
      joined.set_value();
      return true;
    } catch (...) {
      joined.set_exception(std::current_exception());
      return false;
    }
  }

  void serve() {
    std::string text;
    if (settings.commands && ++beats >= std::lround(beats_a_sample * settings.rate_hz * behaviors_asked_s)) {
      beats = 0;
      commands.ask_behaviors();
    }
    for (int i = 0; i < commands_a_beat && (topics->take_event(text) || topics->take(text)); ++i) {
      if (const auto answer = commands.take(text)) topics->answer(*answer);
    }
    while (const auto answer = commands.next()) topics->answer(*answer);
    if (const auto behaviors = commands.behaviors()) topics->listen(*behaviors);
    for (int i = 0; i < events_a_beat && port.next(event); ++i) {
      if (event.kind == Event::Kind::active) topics->tell_active(json_of(event));
    }
  }

  Ros2Settings settings;
  InstancePort& port;
  std::string urdf;
  std::uint32_t every_ticks;
  RowReader reader;
  TextOrders commands;
  std::optional<Ros2Topics> topics;
  std::promise<void> joined;
  std::atomic<bool> running{false};
  std::uint64_t last_tick = UINT64_MAX;
  long beats = 0;  // since it was asked what plays
  Event event;
  PosixWait wait{0, WallClock().now_ns()};
  TaskThread thread;
};

Ros2Bridge::Ros2Bridge(const Ros2Settings& settings, const Parts& parts)
    : inside_(std::make_unique<Inside>(settings, parts)) {
  std::future<void> joined = inside_->joined.get_future();
  inside_->thread.start();
  joined.get();
}

Ros2Bridge::~Ros2Bridge() { stop(); }

void Ros2Bridge::start() noexcept {
  inside_->port.want_signals(inside_->every_ticks);
  inside_->running.store(true, std::memory_order_release);
}

void Ros2Bridge::stop() noexcept {
  inside_->port.want_signals(0);
  inside_->thread.stop();
  inside_->thread.join();
  if (!inside_->topics) return;  // it has left already
  inside_->topics.reset();
  if (const std::string why = inside_->thread.failure(); !why.empty())
    program_log().message(Line::no_time, BehaviorLog::Severity::error, "ros2", "ended: " + why);
}

}  // namespace kadans
