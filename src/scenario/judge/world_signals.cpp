#include "world_signals.h"

#include <algorithm>
#include <cmath>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

double length(const Vec3& v) noexcept { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

}  // namespace

WorldSignals::WorldSignals(SignalTable& table, const WorldSettings& world, std::span<const std::size_t> feet)
    : objects_(world.objects.size()) {
  for (const std::size_t link : feet) feet_.set(link);
  table.add({"plant.contact.other_links", "", "Links other than feet that press on the ground or an object."},
            &other_links_);
  table.add({"plant.self_penetration_m", "m", "Largest overlap of two links of the robot."}, &self_penetration_m_);
  for (std::size_t i = 0; i < objects_.size(); ++i) declare(table, world.objects[i], objects_[i]);
}

void WorldSignals::declare(SignalTable& table, const WorldObject& object, State& state) {
  const std::string name = "world." + object.name + ".";
  table.add({name + "force_N", "N", "Force of the robot on the object."}, &state.force_N);
  table.add({name + "links", "", "Links of the robot that press on the object."}, &state.links);
  if (!object.free() && !object.motion.moves()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string axis(1, "xyz"[i]);
    std::string velocity = name;
    velocity += "v" + axis + "_m_s";
    table.add({name + axis + "_m", "m", "Position of the object."}, &state.position_m[i]);
    table.add({velocity, "m/s", "Velocity of the object."}, &state.velocity_m_s[i]);
  }
  table.add({name + "tilt_rad", "rad", "Angle between the object's z axis and up."}, &state.tilt_rad);
}

void WorldSignals::update(const PlantTruth& truth) noexcept {
  other_links_ = static_cast<double>((truth.touching_links & ~feet_).count());
  self_penetration_m_ = truth.self_penetration_m;
  const std::size_t count = std::min<std::size_t>(objects_.size(), truth.object_count);
  for (std::size_t i = 0; i < count; ++i) {
    const ObjectTruth& object = truth.objects[i];
    State& state = objects_[i];
    const Vec3 up = rotate(object.pose.orientation, {0, 0, 1});
    state.force_N = length(object.force_N);
    state.links = static_cast<double>(object.links.count());
    state.position_m = object.pose.position_m;
    state.velocity_m_s = object.velocity_m_s;
    state.tilt_rad = std::atan2(std::hypot(up[0], up[1]), up[2]);
  }
}

}  // namespace kadans
