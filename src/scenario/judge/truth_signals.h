// The true state of a simulated robot as signals, for checks and pictures, never for control.
//
//   plant.base.height_m, x_m, y_m, tilt_rad, yaw_rad, speed_m_s     of the base frame in the world
//   plant.base.jump_m           distance that the base moved in this step beyond what its speed explains: a teleport
//   plant.foot.<link>.force_N, slip_m   slip: horizontal distance from the place where the foot settled
//   plant.limits.position_rad   distance of the worst joint from its limits; negative when it is beyond them
//   plant.limits.motor_torque_share   the largest torque of a motor, as a share of its joint's limit. Torque that the
//                                     motor cannot give at its speed counts as used. Above 1 the plant is wrong
//   plant.limits.torque_share   the largest torque of a transmission on its joint, as a share of the limit. It is above
//                               1 when a limb hits something, because the rotor behind it must be stopped, too
//   plant.limits.speed_share    the largest joint velocity, as a share of its limit. It is above 1 when something turns
//                               the joint faster than its motor could; no motor accelerates it any more then
//   plant.limits.overspeed_s    for how long a joint has now been above its limit without a break
//   plant.work_J                mechanical work of all motors so far, |torque * joint velocity|, summed. One that
//                               brakes counts as one that drives: nothing is won back
//   reference.base.height_m     the height of the base if every joint were at its set-point
//   reference.base.error_m      plant.base.height_m minus reference.base.height_m
//   plant.contact.other_links      links of the robot, other than feet, that press on the ground, an object or a robot
//   plant.contact.robot_links      in a world of several robots: links that press on another robot
//   plant.contact.robots_force_N   likewise: size of the force from other robots
//   plant.self_penetration_m       largest overlap of two links of the robot
//   world.<name>.force_N, links    force of the robot on the object, and number of its links that press
//   world.<name>.x_m, y_m, z_m, vx_m_s, vy_m_s, vz_m_s, tilt_rad    position, velocity and tilt of an object that can
//   move
//   world.<name>.roll_rad, pitch_rad, yaw_rad    how a free box is turned
//   world.ground.x_m, y_m, z_m     how far a ground that is driven has gone
// The last two follow from what a run's state hash covers already, and are left out of it. It also declares the signals
// of GazeTruth for eyes that are watched.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/model/kinematics.h"
#include "kadans/plant/world.h"

namespace kadans {

// The true error of the eyes of a control object of type "gaze", as signals:
//
//   plant.<object>.left_error_rad, right_error_rad   angle between an eye's x axis and the direction to the target
//   plant.<object>.error_rad                         the larger of the two
//
// The error is computed from the model's joint angles, not from the measured ones, so checks see what the control side
// cannot.
class GazeTruth {
 public:
  struct Eyes {
    std::string object, left, right;  // the control object, the eyes' links
  };
  // Looks the object's target up in the catalog's signals.
  GazeTruth(const TruthSource& plant, const Catalog& catalog, const Eyes& eyes);

  // Declares the signals. This object must not move from then on.
  void declare(SignalTable& table);
  void update(std::span<const double> row) noexcept;

 private:
  const TruthSource& plant_;
  std::string object_;
  std::size_t joints_;
  Kinematics kinematics_;
  std::array<std::size_t, 2> links_;
  std::array<SignalId, 3> target_;
  std::array<double, 2> error_rad_{};
  double worst_rad_ = 0;
};

class TruthSignals {
 public:
  // The constructor declares the signals in the catalog and keeps references to plant, model and catalog. `feet` are
  // the foot links of the plant's settings, each with the points of its sole that touch the ground. Slip is measured
  // from settle_s on. `several`: the plant's world has more than one robot.
  struct Foot {
    std::string link;
    std::vector<Vec3> sole_m;  // in the link's frame
  };
  TruthSignals(const TruthSource& plant, Catalog& catalog, const std::vector<Foot>& feet, double settle_s,
               const WorldSettings& world = {}, bool several = false);

  // Call before the run.
  void watch(Catalog& catalog, const GazeTruth::Eyes& eyes);

  // Call after each step of the plant. `row` holds the signals of the last control tick; the set-points are read from
  // it.
  void update(double time_s, std::span<const double> row) noexcept;
  std::span<const SignalId> unhashed() const noexcept { return unhashed_; }  // not in a run's state hash; ascending

 private:
  struct State {
    double height_m = 0, x_m = 0, y_m = 0, tilt_rad = 0, yaw_rad = 0, speed_m_s = 0, jump_m = 0;
    double position_rad = 0, motor_torque_share = 0, torque_share = 0, speed_share = 0, overspeed_s = 0;
    double residual_m_s = 0, work_J = 0;
    double reference_height_m = 0, reference_error_m = 0;
    double other_links = 0, robot_links = 0, robots_force_N = 0, self_penetration_m = 0;
    Vec3 ground_m{};
  };
  struct FootState {
    std::size_t link = 0;
    std::vector<Vec3> sole_m;
    bool settled = false;
    Vec3 settled_at_m{};
    double force_N = 0, slip_m = 0;
  };
  struct ObjectState {
    double force_N = 0, links = 0;
    Vec3 position_m{}, velocity_m_s{}, angles_rad{};
    double tilt_rad = 0;
  };
  void declare(SignalTable& table, const std::vector<Foot>& feet);
  void declare_world(SignalTable& table, const WorldSettings& world, bool several);
  void declare_object(SignalTable& table, const WorldObject& object, ObjectState& state);
  void update_world() noexcept;
  void update_limits(double dt_s) noexcept;
  void update_jump(double dt_s) noexcept;
  void update_feet(double time_s) noexcept;
  double reference_rad(std::size_t joint, std::span<const double> row) const noexcept;
  double reference_height_m(std::span<const double> row) noexcept;

  const TruthSource& plant_;
  const RobotModel& model_;
  double settle_s_;
  Kinematics kinematics_;
  State state_;
  std::array<double, max_joints> overspeed_s_{};
  std::optional<double> last_s_;  // time of the step before; its base position and speed follow
  Vec3 last_m_{};
  double last_m_s_ = 0;
  std::vector<FootState> feet_;
  LinkSet foot_links_;
  std::vector<ObjectState> objects_;
  std::vector<SignalId> unhashed_;
  std::vector<std::unique_ptr<GazeTruth>> gazes_;
  struct Reference {  // a control object's set-point of a joint
    std::uint32_t object;
    SignalId signal;
  };
  std::array<std::vector<Reference>, max_joints> references_;
  std::array<SignalId, max_joints> writers_{};  // signals that say which objects have a share in the joint
  std::array<double, max_joints> position_rad_{};
};

}  // namespace kadans
