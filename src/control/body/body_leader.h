// The high level of a whole-body object: a robot in thought that the tasks lead and the real one follows.
//
// Its state begins as the robot's was measured. Each behavior tick it moves on with the accelerations that the program
// found in the last one, and a new program is solved for the state where it is now. The control thread gets positions,
// velocities, accelerations and torques of the joints, and closes their loops around them. So noise and delays of the
// measurements do not go through the program; what the real robot deviates is the joints' loops to hold. The floor
// counts as flat, and a foot that comes to stand as flat on it.
//
// Behavior thread. Only the constructor allocates or throws.
#pragma once

#include "body_problem.h"

namespace kadans {

class BodyLeader {
 public:
  explicit BodyLeader(const BodyLayout& layout);

  // From the state in `aim`, which is of a new activation.
  void begin(const BodyAim& aim) noexcept;
  // Moves on by dt_s, then solves anew.
  void step(const BodyAim& aim, double dt_s, BodyLead& lead) noexcept;
  void pass_state(StateBytes& bytes) noexcept;

 private:
  void stand(const BodyAim& aim, double dt_s) noexcept;
  void weigh(const BodyAim& aim, double dt_s) noexcept;
  void fill(const BodyAim& aim, BodyLead& lead) const noexcept;

  const BodyLayout* layout_;
  BodyModel model_;
  Kinematics kinematics_;  // for the start
  BodyProblem problem_;
  std::array<BodyStand, body_feet_max> feet_;
  BodyRanks ranks_;
  BodyPosture posture_;
  Eigen::VectorXd acceleration_, way_;
  bool fresh_ = true;  // begun, not moved on yet
};

// Where the robot of `aim` stands, and what its set-points are there: for the start, and for reach.
Pose body_start(const BodyLayout& layout, const BodySettings& settings, Kinematics& kinematics,
                std::span<const double> position_rad, const Quat& base) noexcept;

inline constexpr double gaze_ahead_m = 1;  // of the point at which an idle gaze looks

// What the set-points of this task are where the robot is: a position, or roll, pitch and yaw, or one after the other.
template <typename Robot>
std::array<double, 6> present_task(const BodyTask& task, const BodySettings& settings, const Vec3& point_m,
                                   const Robot& robot) noexcept {
  const Pose& link = robot.link(task.link);
  const Vec3 turn = roll_pitch_yaw(link.orientation);
  Vec3 at = task.kind == BodyTask::Kind::com    ? robot.com_m()
            : task.kind == BodyTask::Kind::gaze ? transform(link, {gaze_ahead_m, 0, 0})
                                                : transform(link, point_m);
  if (task.kind == BodyTask::Kind::foot) at[2] -= settings.sole_m;
  if (!task.has_point()) return {turn[0], turn[1], turn[2]};
  return {at[0], at[1], at[2], turn[0], turn[1], turn[2]};
}

template <typename Robot>
void present_setpoints(const BodyLayout& layout, const BodySettings& settings, const Robot& robot,
                       std::array<SetpointState, body_channels_max>& setpoints) noexcept {
  for (std::size_t i = 0; i < layout.tasks.size(); ++i) {
    const BodyTask& task = layout.tasks[i];
    const std::array<double, 6> at = present_task(task, settings, settings.tasks[i].point_m, robot);
    for (std::size_t k = 0; k < task.channels(); ++k) setpoints[task.channel + k] = {.value = at[k]};
  }
  for (std::size_t i = 0; i < layout.feet.size(); ++i) setpoints[layout.contact_channel + i] = {.value = 1};
  setpoints[layout.lead_channel] = {.value = 1};
}

}  // namespace kadans
