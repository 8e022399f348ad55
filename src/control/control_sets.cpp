#include "kadans/control/control_sets.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kadans {
namespace {

void check_set(const Catalog& catalog, const ControlSetInfo& set) {
  std::vector<char> driven(max_joints, 0);
  std::vector<char> listed(catalog.objects.size(), 0);
  if (set.objects.empty()) throw std::invalid_argument("control set " + set.name + " has no control object");
  for (const std::uint32_t index : set.objects) {
    const ObjectInfo& object = catalog.objects.at(index);
    if (std::exchange(listed[index], 1)) {
      throw std::invalid_argument("control set " + set.name + " lists " + object.name + " twice");
    }
    for (const std::size_t joint : object.joints) {
      if (std::exchange(driven.at(joint), 1)) {
        throw std::invalid_argument("control set " + set.name + ": more than one object drives joint " +
                                    catalog.model->joints.at(joint).name);
      }
    }
  }
}

}  // namespace

ControlSets::ControlSets(const Catalog& catalog, std::vector<std::unique_ptr<ControlObject>> objects)
    : catalog_(catalog),
      objects_(std::move(objects)),
      running_(objects_.size(), 0),
      active_(catalog.initial_set),
      computing_(static_cast<std::uint32_t>(catalog.sets.size())) {
  if (objects_.size() > max_objects) {
    throw std::invalid_argument(std::to_string(objects_.size()) + " control objects, at most " +
                                std::to_string(max_objects) + " are possible");
  }
  if (objects_.size() != catalog.objects.size()) throw std::invalid_argument("the catalog lists other control objects");
  if (catalog.initial_set >= catalog.sets.size()) throw std::invalid_argument("there is no initial control set");
  for (const ControlSetInfo& set : catalog.sets) check_set(catalog, set);
}

void ControlSets::change_over(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const auto& objects = catalog_.sets[active_].objects;
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    if (std::find(objects.begin(), objects.end(), i) == objects.end()) running_[i] = 0;
  }
  for (std::uint32_t joint = 0; joint < actuation.joint_count; ++joint) actuation.joints[joint] = {};
  for (const std::uint32_t index : objects) {
    if (!std::exchange(running_[index], 1)) objects_[index]->start(input);
  }
  computing_ = active_;
}

void ControlSets::step(std::uint64_t tick, const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool changed = computing_ != active_;
  if (changed) change_over(input, actuation);
  for (const std::uint32_t index : catalog_.sets[active_].objects) {
    const std::uint32_t divisor = catalog_.objects[index].divisor;
    if (tick % divisor != 0 && !changed) continue;
    const ControlInput slower{input.joints, input.status, input.last, input.time_ns, input.dt_s * divisor};
    objects_[index]->step(slower, actuation);
  }
}

void ControlSets::fill(std::uint32_t& active_set, std::uint32_t& count,
                       std::array<ObjectStatus, max_objects>& status) const noexcept {
  active_set = active_;
  count = static_cast<std::uint32_t>(objects_.size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    status[i] = {.active = running_[i] != 0, .motion_remaining_s = objects_[i]->motion_remaining_s()};
  }
}

void ControlSets::update(std::uint64_t behavior_tick, const Snapshot& snapshot) {
  for (const std::uint32_t index : catalog_.sets.at(snapshot.control_set).objects) {
    if (behavior_tick % catalog_.objects[index].high_level_divisor == 0) objects_[index]->update(snapshot);
  }
}

}  // namespace kadans
