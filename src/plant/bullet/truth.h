// Reads the robot's true state out of Bullet, in the model's terms, once a step.
#pragma once

#include <vector>

#include "body.h"
#include "kadans/plant/world.h"
#include "plant/bullet/joint/drives.h"
#include "world_objects.h"

namespace kadans::bullet {

// The load on a foot from what it stands on.
struct FootLoad {
  std::size_t link = 0;
  btVector3 force_N{0, 0, 0};                         // world axes
  std::array<double, sensors_per_foot> pressure_N{};  // normal force, distributed over the sensors
};

class TruthReader {
 public:
  TruthReader(const Body& body, std::size_t joints);

  void read(const Drives& drives, const std::vector<FootLoad>& feet);
  // After a step of dt_s, or before the first with 0.
  void read_world(const ContactWorld& world, const WorldObjects& objects, double dt_s);
  const PlantTruth& truth() const noexcept { return truth_; }

  // Of the base frame's point `point_in_base_m`, world axes.
  btVector3 base_point_velocity_m_s(const btVector3& point_in_base_m) const;

 private:
  void read_com();

  const Body* body_;
  PlantTruth truth_;
  std::vector<btVector3> omegas_, velocities_;
};

}  // namespace kadans::bullet
