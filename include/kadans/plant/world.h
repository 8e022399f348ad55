// A simulated world. It steps, offers a plant for its robot, knows the true state and can push the robot. Hardware is a
// plant without a world.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>

#include "kadans/model/robot_model.h"
#include "kadans/plant/plant.h"
#include "kadans/plant/world_settings.h"
#include "kadans/signal/state_hash.h"

namespace kadans {

using LinkSet = std::bitset<max_joints + 1>;  // by number, 0 is the base

// An object of the world, in the order of the settings.
struct ObjectTruth {
  Pose pose;
  Vec3 velocity_m_s{}, angular_velocity_rad_s{};  // world axes; of a conveyor those of its surface
  Vec3 force_N{};                                 // from the robot, world axes
  LinkSet links;                                  // that press on it
};

// The true state, for checks and pictures: a model knows it, hardware does not.
struct PlantTruth {
  Pose base;
  Vec3 base_velocity_m_s{};            // of the base frame's origin, world axes
  Vec3 base_angular_velocity_rad_s{};  // world axes
  Vec3 com_m{};
  Vec3 com_velocity_m_s{};
  std::uint32_t joint_count = 0;
  std::array<double, max_joints> position_rad{};
  std::array<double, max_joints> velocity_rad_s{};
  std::array<double, max_joints> drive_torque_Nm{};  // what each drive put on its joint in the last step
  // Torque of the motor alone, reflected to the joint, and the most that it can give at its speed, in that direction.
  // The torque on the joint is larger where the joint is hit or brakes: then the transmission also carries the rotor's
  // inertia. Of drives that couple two joints, these two are in the drive's own coordinate (transmission.h).
  std::array<double, max_joints> motor_torque_Nm{}, motor_torque_max_Nm{};
  std::uint32_t foot_count = 0;
  std::array<Pose, max_feet> feet{};
  std::array<Vec3, max_feet> foot_force_N{};  // from what the foot stands on, world axes
  std::uint32_t object_count = 0;
  std::array<ObjectTruth, max_world_objects> objects{};
  LinkSet ground_links;             // that press on the ground
  LinkSet touching_links;           // that press on the ground or an object
  std::uint32_t contact_count = 0;  // points of the robot that press on something
  double self_penetration_m = 0;    // largest overlap of two links that may collide
};

class TruthSource {
 public:
  virtual ~TruthSource() = default;
  TruthSource() = default;
  TruthSource(const TruthSource&) = delete;
  TruthSource& operator=(const TruthSource&) = delete;
  virtual const PlantTruth& truth() const noexcept = 0;  // as of the last step
};

// The thread that owns a world calls all its functions, except read() and write() of the robot, outside of ticks: they
// may allocate.
class World : public TruthSource {
 public:
  virtual Plant& robot() noexcept = 0;
  // Lets time pass. Throws std::runtime_error when the model fails (a state that is not finite).
  virtual void step(std::int64_t dt_ns) = 0;
  // A force in world axes at a point of a link, for the next step only.
  virtual void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) = 0;
  // Adds everything that decides how the world goes on to the hash.
  virtual void hash(StateHash& hash) const noexcept = 0;
};

// A world of one robot, which is its plant too.
class OneRobotWorld : public World, public Plant {
 public:
  Plant& robot() noexcept final { return *this; }
};

}  // namespace kadans
