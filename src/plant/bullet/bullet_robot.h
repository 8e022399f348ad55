// One robot of a Bullet world: body, drives, electronics and sensors, in a contact world of its own.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "body.h"
#include "divergence.h"
#include "kadans/plant/modelled_drives.h"
#include "plant/bullet/joint/drives.h"
#include "sensors.h"

namespace kadans::bullet {

class BulletRobot final : public WorldRobot {
 public:
  // Keeps references to settings and objects. The first robot's contact world has the objects, too.
  BulletRobot(const WorldSite& site, const PlantSettings& settings, FrictionLaw friction, WorldObjects& objects,
              bool first);

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void write_drives(const ActuationFrame& drives) noexcept override;
  const PlantTruth& truth() const noexcept override { return truth_.truth(); }
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) override;
  void carry(double x_m, double y_m, double heading_rad) override;

  // Of all robots, with its own; once, before the first step. It is carried beside what stands in them.
  void stand_among(std::span<ContactWorld* const> worlds) noexcept { worlds_ = worlds; }

  // A step: begin, then that of the contact world, end, and sample once the objects have moved, too.
  void begin_step(std::int64_t dt_ns);
  void end_step(double dt_s);  // throws std::runtime_error when the model diverges
  void sample(std::int64_t dt_ns);
  ContactWorld& world() noexcept { return world_; }
  const btMultiBody& multibody() const noexcept { return body_.multibody(); }

  void hash_body(StateHash& hash) const noexcept;
  void hash_contacts(StateHash& hash) const noexcept;
  void hash_sensors(StateHash& hash) const noexcept;  // carries the random streams' effect

 private:
  void take(const ActuationFrame& actuation) noexcept;
  void ask_drives() noexcept;
  void read_state(double dt_s);

  const PlantSettings& settings_;
  const WorldObjects& objects_;
  Body body_;
  PairMask mask_;
  Drives drives_;
  Divergence divergence_;
  ModelledDrives electronics_;
  ActuationFrame asked_;  // of the drives
  std::vector<FootLoad> feet_;
  Sensors sensors_;
  TruthReader truth_;
  ContactWorld world_;  // last: it lets go of the parts above before they end
  std::span<ContactWorld* const> worlds_;
  std::int64_t time_ns_ = 0;
};

}  // namespace kadans::bullet
