#include "behavior_link.h"

#include "kadans/signal/state_hash.h"

namespace kadans {
std::uint64_t fingerprint_of(const Catalog& catalog) {
  StateHash hash;
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id) {
    const Parameter& parameter = catalog.parameters.info(id);
    hash.add(parameter.name);
    hash.add(parameter.min);
    hash.add(parameter.max);
  }
  for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) {
    const Setpoint& setpoint = catalog.setpoints[id];
    hash.add(setpoint.name);
    hash.add(setpoint.min);
    hash.add(setpoint.max);
    hash.add(setpoint.owner);
    hash.add(setpoint.joint);
    hash.add(setpoint.follows);
  }
  for (const ObjectInfo& object : catalog.objects) {
    hash.add(object.name);
    for (const Preset& preset : object.presets) {
      hash.add(preset.name);
      for (const auto& value : preset.values) hash.add(value.first), hash.add(value.second);
    }
  }
  for (const ControlSetInfo& set : catalog.sets) {
    hash.add(set.name);
    for (const std::uint32_t object : set.objects) hash.add(object);
  }
  for (const PoseInfo& pose : catalog.poses) {
    hash.add(pose.name);
    for (const auto& position : pose.position_rad) hash.add(position.first), hash.add(position.second);
  }
  for (const Joint& joint : catalog.model->joints) hash.add(joint.name);
  hash.add(catalog.initial_sets);
  return hash.value();
}

}  // namespace kadans
