// Contacts and the positions of the world's objects, as signals:
//
//   plant.contact.other_links      links of the robot, other than feet, that press on the ground or an object
//   plant.self_penetration_m       largest overlap of two links of the robot
//   world.<name>.force_N, links    force of the robot on the object, and number of its links that press
//   world.<name>.x_m, y_m, z_m, vx_m_s, vy_m_s, vz_m_s, tilt_rad    position, velocity and tilt of an object that can
//   move
#pragma once

#include <span>
#include <vector>

#include "kadans/plant/world.h"

namespace kadans {

class WorldSignals {
 public:
  // Declares the signals. `feet` are the indices of the foot links.
  WorldSignals(SignalTable& table, const WorldSettings& world, std::span<const std::size_t> feet);

  void update(const PlantTruth& truth) noexcept;

 private:
  struct State {
    double force_N = 0, links = 0;
    Vec3 position_m{}, velocity_m_s{};
    double tilt_rad = 0;
  };
  void declare(SignalTable& table, const WorldObject& object, State& state);

  LinkSet feet_;
  double other_links_ = 0, self_penetration_m_ = 0;
  std::vector<State> objects_;
};

}  // namespace kadans
