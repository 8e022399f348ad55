// A plant without physics, for tests. Each joint is a double integrator with its own inertia. Commands in position and
// velocity mode are reached at once. The base stands still and upright. Drives that couple two joints are such
// integrators themselves, and the joints follow them.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/plant/modelled_drives.h"
#include "kadans/plant/settings.h"
#include "kadans/plant/world.h"

namespace kadans {

class IdealWorld final : public OneRobotWorld {
 public:
  // settings.position_rad is where the joints start. Each joint's inertia is its rotor's, or 1 kg m2 where that is 0.
  IdealWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed = 1);  // of the sensors' noise

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void write_drives(const ActuationFrame& drives) noexcept override;
  void step(std::int64_t dt_ns) override;
  const PlantTruth& truth() const noexcept override { return truth_; }
  void push(std::size_t, const Vec3&, const Vec3&) override {}
  void hash(StateHash& hash) const noexcept override;

 private:
  void take(const ActuationFrame& actuation) noexcept;
  void move_drive(std::size_t drive, double dt_s) noexcept;
  void map_coupled(bool to_drives) noexcept;

  std::vector<Transmission> couplings_;
  std::vector<std::pair<std::size_t, Mimic>> mimics_;  // by joint
  std::array<double, max_joints> inertia_kg_m2_{};
  std::array<double, max_joints> lower_rad_{}, upper_rad_{};
  ActuationFrame actuation_;
  PlantTruth truth_;
  ModelledDrives drives_;
  ModelledChannels channels_;
  std::int64_t time_ns_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace kadans
