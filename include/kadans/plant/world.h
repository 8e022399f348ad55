// A simulated world. It steps. For each of its robots it offers a plant, the true state, and a way to push the robot.
// Hardware is a plant without a world.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/plant/plant.h"
#include "kadans/plant/settings.h"
#include "kadans/signal/state_hash.h"

namespace kadans {

using LinkSet = std::bitset<max_joints + 1>;  // by number, 0 is the base

// An object of the world, in the order of the settings.
struct ObjectTruth {
  Pose pose;
  Vec3 velocity_m_s{}, angular_velocity_rad_s{};  // world axes; of a conveyor those of its surface
  Vec3 force_N{};                                 // from this robot, world axes
  LinkSet links;                                  // that press on it
};

// The true state of one robot, and of the world as this robot touches it, for checks and pictures: a model knows it,
// hardware does not.
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
  Vec3 ground_m{};                  // how far a ground that is driven has gone
  LinkSet ground_links;             // that press on the ground
  LinkSet robot_links;              // that press on another robot
  Vec3 robots_force_N{};            // from other robots, world axes
  LinkSet touching_links;           // that press on the ground, an object or another robot
  std::uint32_t contact_count = 0;  // points of the robot that press on something
  double self_penetration_m = 0;    // largest overlap of two links that may collide
  double residual_m_s = 0;          // what the solver left open: by how much its last iteration changed a velocity
};

class TruthSource {
 public:
  virtual ~TruthSource() = default;
  TruthSource() = default;
  TruthSource(const TruthSource&) = delete;
  TruthSource& operator=(const TruthSource&) = delete;
  virtual const PlantTruth& truth() const noexcept = 0;  // as of the last step
};

// One robot of a world.
class WorldRobot : public Plant, public TruthSource {
 public:
  // As write(), but with the actuation of the drives themselves, as Transmission::to_drives maps it: so that faults of
  // drives can be simulated. The default is for models without couplings.
  virtual void write_drives(const ActuationFrame& drives) noexcept { write(drives); }
  // A force in world axes at a point of a link, for the next step only. Throws std::invalid_argument when there is no
  // such link, or a number is not finite.
  virtual void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) = 0;
  // A person lifts the robot, its tilt and joints as they are, and puts it down at rest with its base over this place
  // and turned to this heading; where it would lie in another robot or an object, beside it, to the left or to the
  // right; on what stands there, it stands. Throws std::invalid_argument when the robot cannot be lifted, when there is
  // no room within 3 m, or when a number is not finite.
  virtual void carry(double x_m, double y_m, double heading_rad) {
    (void)x_m, (void)y_m, (void)heading_rad;
    throw std::invalid_argument("carry: this robot is fixed in its place");
  }
};

// A robot that a world is made for. `seed` feeds every noise of it.
struct WorldSite {
  const RobotModel& model;
  const PlantSettings& settings;
  std::uint64_t seed = 1;
};

// The thread that owns a world calls all its functions, except read() and write() of its robots, outside of ticks: they
// may allocate.
class World {
 public:
  virtual ~World() = default;
  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  virtual std::size_t robot_count() const noexcept = 0;  // at least 1
  virtual WorldRobot& robot(std::size_t number) noexcept = 0;
  // Lets time pass. Throws std::runtime_error when the model fails (a state that is not finite).
  virtual void step(std::int64_t dt_ns) = 0;
  // A person puts a free object, turned as at the start, at rest with its centre here; where it would lie in a robot or
  // in another object, beside that. Throws std::invalid_argument when there is no such object, it is not free, it would
  // lie in the ground, there is no room within 3 m, or a number is not finite.
  virtual void put(std::size_t object, const Vec3& position_m) {
    (void)object, (void)position_m;
    throw std::invalid_argument("put: this world has no objects");
  }
  // Adds everything that decides how the world goes on to the hash.
  virtual void hash(StateHash& hash) const noexcept = 0;
};

// A world of one robot, which is its plant too.
class OneRobotWorld : public World, public WorldRobot {
 public:
  std::size_t robot_count() const noexcept final { return 1; }
  WorldRobot& robot(std::size_t) noexcept final { return *this; }
};

// A world of one robot around a robot of another world: what it does not change passes through, but for write_drives(),
// which comes as write(), as to every plant that does not take drives. It opens and closes nothing.
class WorldAround : public OneRobotWorld {
 public:
  void declare_signals(SignalTable& table) const override { robot_.declare_signals(table); }
  std::vector<PlantCount> link_counts() const override { return robot_.link_counts(); }
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) override {
    robot_.push(link, force_N, point_in_link_m);
  }
  void carry(double x_m, double y_m, double heading_rad) override { robot_.carry(x_m, y_m, heading_rad); }
  void put(std::size_t object, const Vec3& position_m) override { world_.put(object, position_m); }
  void step(std::int64_t dt_ns) override { world_.step(dt_ns); }
  const PlantTruth& truth() const noexcept override { return robot_.truth(); }
  void hash(StateHash& hash) const noexcept override { world_.hash(hash); }

 protected:
  // Keeps a reference.
  explicit WorldAround(World& world, std::size_t robot = 0) noexcept : world_(world), robot_(world.robot(robot)) {}
  explicit WorldAround(std::unique_ptr<World> world) noexcept : WorldAround(*world) { owned_ = std::move(world); }

  World& world_;
  WorldRobot& robot_;

 private:
  std::unique_ptr<World> owned_;
};

}  // namespace kadans
