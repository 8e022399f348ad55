// The seam between the control engine and what it controls.
//
// read and write are called once a tick by the control thread: sample first, actuate a constant time later. Both are
// bounded and make no system call that may block. step belongs to models alone: it lets `dt_ns` pass. Hardware lives
// on its own and leaves step empty.
#pragma once

#include <bitset>
#include <cstdint>

#include "kadans/model/robot_model.h"
#include "kadans/plant/world.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/state_hash.h"

namespace kadans {

class Plant {
 public:
  virtual ~Plant() = default;
  Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  // Control thread. Fills sensors as they are now, counts included.
  virtual void read(SensorFrame& sensors) noexcept = 0;
  // Control thread. Holds until the next write.
  virtual void write(const ActuationFrame& actuation) noexcept = 0;
  // Control thread, in the wait before a tick: read and write will follow soon. Changes nothing.
  virtual void warm() noexcept {}
  // The thread that owns the model; outside the tick, so it may allocate. Throws std::runtime_error when the model
  // fails (a state that is not finite).
  virtual void step(std::int64_t dt_ns) = 0;
};

using LinkSet = std::bitset<max_joints + 1>;  // by number, 0 is the base

// An object of the world, in the order of the settings.
struct ObjectTruth {
  Pose pose;
  Vec3 velocity_m_s{}, angular_velocity_rad_s{};  // world axes; of a conveyor its surface's
  Vec3 force_N{};                                 // from the robot, world axes
  LinkSet links;                                  // that press on it
};

// What a model knows and hardware does not: the truth, for checks and pictures, and hands to push the robot with.
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
  // Of the motor alone, reflected to the joint, and the most that it can give at its speed, in that direction. The
  // torque on the joint is more than that where the joint is hit or brakes: then the transmission carries the rotor's
  // own inertia.
  std::array<double, max_joints> motor_torque_Nm{}, motor_torque_max_Nm{};
  std::uint32_t foot_count = 0;
  std::array<Pose, max_feet> feet{};
  std::array<Vec3, max_feet> foot_force_N{};  // from whatever the foot stands on, world axes
  std::uint32_t object_count = 0;
  std::array<ObjectTruth, max_world_objects> objects{};
  LinkSet ground_links;             // that press on the ground
  LinkSet touching_links;           // that press on the ground or an object
  std::uint32_t contact_count = 0;  // points of the robot that press on something
  double self_penetration_m = 0;    // largest overlap of two links that may collide
};

class ModelPlant : public Plant {
 public:
  virtual const PlantTruth& truth() const noexcept = 0;  // as of the last step
  // A force in world axes at a point of a link, for the next step only.
  virtual void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) = 0;
  // Everything that decides how the model goes on.
  virtual void hash(StateHash& hash) const noexcept = 0;
};

}  // namespace kadans
