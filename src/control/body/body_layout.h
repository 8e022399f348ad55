// What a whole-body object is made of: its tasks, the joints that it drives, and what crosses between its two levels.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"

namespace kadans {

inline constexpr std::size_t body_tasks_max = 8, body_feet_max = 2;
inline constexpr std::size_t body_channels_max = 33 + max_joints;
inline constexpr double body_gravity_m_s2 = 9.81;
inline constexpr std::size_t no_body_joint = max_joints;  // an index that no joint has

// A task leads the centre of mass, a point of a link, the orientation of a link, or both; or where a link looks.
struct BodyTask {
  enum class Kind : std::uint8_t { com, foot, hand, trunk, gaze };
  Kind kind = Kind::com;
  std::string name;           // "foot_left"
  std::size_t link = 0;       // not of com
  std::uint32_t channel = 0;  // of its first set-point: x, y, z, then roll, pitch, yaw, as far as it has them

  bool has_point() const noexcept { return kind != Kind::trunk; }
  bool has_turn() const noexcept { return kind == Kind::foot || kind == Kind::trunk; }
  bool idles() const noexcept { return kind == Kind::hand || kind == Kind::gaze; }  // until it is moved
  std::uint32_t channels() const noexcept { return has_point() && has_turn() ? 6 : 3; }
};

// The tunables of all tasks, as the high level gets them.
struct BodySettings {
  struct Task {
    double weight = 1;      // 0: left out
    double priority = 1;    // 1 or 2: the second level gets what the first one leaves
    double gain_per_s = 8;  // the error's natural frequency
    Vec3 point_m{};         // of a hand: in its link's frame
  };
  std::array<Task, body_tasks_max> tasks{};
  double friction = 0.5;                            // of the ground
  double toe_m = 0.1, heel_m = 0.1, side_m = 0.05;  // from the foot's frame to the sole's edges
  double sole_m = 0.05;                             // of the foot's frame over the sole
  double edge_m = 0.01;                             // how far the centre of pressure stays from the edges
  double balance_m = 0.03;      // how far the centre of mass, and the point over which it comes to rest, stay from them
  double effort_share = 0.9;    // of the joints' torque limits
  double velocity_share = 0.8;  // of their velocity limits
  double tilt_max_rad = 3.2;    // of the trunk, on the way of a motion
  double posture_weight = 1e-3, posture_per_s = 2;
  double passive_Nm_per_rad = 0, passive_Nms_per_rad = 0;  // springs and dampers in joints without motors
};

struct BodyLayout {
  // Throws OptionError and std::invalid_argument, with what is wrong.
  explicit BodyLayout(const ObjectSetup& setup);

  const RobotModel* model;
  bool floating = false;  // it has feet
  std::vector<JointAxis> joints;
  std::vector<std::size_t> passive, locked;  // joints of the model: without a motor, or driven by somebody else
  std::vector<BodyTask> tasks;
  std::vector<std::size_t> feet;        // of tasks, left and right
  struct Sole {                         // of a foot
    std::size_t loose = no_body_joint;  // the joint without a motor that is nearest to it, on the way to the base
    bool tilts_forward = false, tilts_sideways = false;  // about this joint, as the foot stands
  };
  std::array<Sole, body_feet_max> soles{};
  std::uint32_t contact_channel = 0;  // of the left foot's contact: 1: it stands, 0: it is free
  std::uint32_t lead_channel = 0;     // 1: the tasks lead; 0: the posture alone does
  std::uint32_t joint_channel = 0;    // of the first joint's position
  std::vector<double> rotor_inertia_kg_m2;

  std::uint32_t channels() const noexcept { return joint_channel + static_cast<std::uint32_t>(joints.size()); }
};

// From the low level to the high one.
struct BodyAim {
  std::uint32_t activation = 0;  // 0: not started
  Quat base{1, 0, 0, 0};         // as measured at the start
  std::array<double, max_joints> start_rad{}, start_rad_s{};
  std::array<SetpointState, body_channels_max> setpoints{};
  bool alone = false;                          // the posture leads, without tasks
  std::array<bool, body_tasks_max> engaged{};  // tasks that count: see whole_body.cpp
  BodySettings settings;
};

// And back: where the joints are led from `time_ns` on, and what torques that takes.
struct BodyLead {
  struct Joint {
    double position_rad = 0, velocity_rad_s = 0, acceleration_rad_s2 = 0;
    double effort_Nm = 0, effort_before_Nm = 0;
  };
  struct Foot {
    bool stands = false;
    double load_N = 0;
    std::array<double, 6> pose{};  // x, y, z of the sole's point below the frame, roll, pitch, yaw
  };
  std::uint32_t activation = 0;
  std::int64_t time_ns = 0;
  double period_s = 0.01;
  std::array<Joint, max_joints> joints{};  // by the object's joints
  std::array<Foot, body_feet_max> feet{};
  std::array<std::array<double, 6>, body_tasks_max> tasks{};  // where they are: their set-points would be these
  Vec3 com_m{};
  double iterations = 0, status = 0, failures = 0;  // of the solver
};

}  // namespace kadans
