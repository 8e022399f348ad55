#include "kadans/control/control_sets.h"

#include <stdexcept>
#include <utility>

namespace kadans {
namespace {

void check_set(const Catalog& catalog, const ControlSetInfo& set) {
  std::vector<char> driven(max_joints, 0);
  std::vector<char> listed(catalog.objects.size(), 0);
  if (set.objects.empty()) throw std::invalid_argument("control set " + set.name + " has no control object");
  if (!set.compositions.empty() && set.compositions.size() != set.objects.size()) {
    throw std::invalid_argument("control set " + set.name + ": one composition an object is wanted");
  }
  for (std::size_t i = 0; i < set.objects.size(); ++i) {
    const ObjectInfo& object = catalog.objects.at(set.objects[i]);
    const bool sets = set.compositions.empty() || set.compositions[i] == Composition::set;
    if (std::exchange(listed[set.objects[i]], 1)) {
      throw std::invalid_argument("control set " + set.name + " lists " + object.name + " twice");
    }
    for (const std::size_t joint : object.joints) {
      if (std::exchange(driven.at(joint), 1) && sets) {
        throw std::invalid_argument("control set " + set.name + ": more than one object sets joint " +
                                    catalog.model->joints.at(joint).name);
      }
    }
  }
}

}  // namespace

ControlSets::ControlSets(Catalog& catalog, std::vector<std::unique_ptr<ControlObject>> objects)
    : catalog_(catalog),
      objects_(std::move(objects)),
      switchover_(catalog.drives, catalog.switching),
      active_(catalog.initial_set) {
  if (objects_.size() > max_objects) {
    throw std::invalid_argument(std::to_string(objects_.size()) + " control objects, at most " +
                                std::to_string(max_objects) + " are possible");
  }
  if (objects_.size() != catalog.objects.size()) throw std::invalid_argument("the catalog lists other control objects");
  if (catalog.initial_set >= catalog.sets.size()) throw std::invalid_argument("there is no initial control set");
  for (const ControlSetInfo& set : catalog.sets) check_set(catalog, set);
  for (std::size_t i = 0; i < objects_.size(); ++i) proposals_.push_back(std::make_unique<ActuationFrame>());
  plans_.reserve(catalog.sets.size());  // parameters point into the members
  for (const ControlSetInfo& set : catalog.sets) make_plan(catalog, set);
  declare(catalog);
}

void ControlSets::make_plan(Catalog& catalog, const ControlSetInfo& set) {
  Plan& plan = plans_.emplace_back();
  plan.members.reserve(set.objects.size());
  for (std::size_t i = 0; i < set.objects.size(); ++i) {
    const std::uint32_t index = set.objects[i];
    const ObjectInfo& object = catalog.objects[index];
    const Composition composition = set.compositions.empty() ? Composition::set : set.compositions[i];
    plan.members.push_back({index, object.divisor, composition, 1});
    plan.objects |= 1U << index;
    if (composition != Composition::blend) continue;
    catalog.parameters.add(
        {set.name + "." + object.name + ".weight", "", 0, 1, 1, "Its share in the joints it blends."},
        &plan.members.back().weight, max_objects);
  }
}

void ControlSets::declare(Catalog& catalog) {
  for (std::size_t i = 0; i < catalog.model->joints.size(); ++i) {
    catalog.signals.add({"composition." + catalog.model->joints[i].name + ".writers", "",
                         "Control objects that have a share in its actuation, a bit each."},
                        &writers_[i]);
  }
  catalog.signals.add({"composition.switch_share", "",
                       "Largest step that the last switch absorbed, as a share of the "
                       "joint's torque limit."},
                      &switchover_.absorbed_share());
}

void ControlSets::start_newcomers(const ControlInput& input) noexcept {
  const Plan& plan = plans_[active_];
  for (const Member& member : plan.members) {
    if ((running_ >> member.object & 1U) == 0) objects_[member.object]->start(input);
  }
  running_ = plan.objects;
}

void ControlSets::switch_to(std::uint32_t set) noexcept {
  switched_ = switched_ || set != active_;
  active_ = set;
}

void ControlSets::restart(const ControlInput& input) noexcept {
  running_ = 0;
  switched_ = true;
  start_newcomers(input);
}

void ControlSets::compose_joints(const Member& member, ActuationFrame& actuation) noexcept {
  const ActuationFrame& proposal = *proposals_[member.object];
  const std::uint32_t bit = 1U << member.object;
  for (const std::size_t joint : catalog_.objects[member.object].joints) {
    const bool replaces = member.composition == Composition::set || member.composition == Composition::priority;
    if (!compose(member.composition, member.weight, proposal.joints[joint], actuation.joints[joint])) continue;
    writers_[joint] = replaces ? bit : writers_[joint] | bit;
  }
}

void ControlSets::step(std::uint64_t tick, const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool first = !std::exchange(computed_, true);
  const bool changed = std::exchange(switched_, false) || first;
  switchover_.observe(input.joints, input.dt_s);
  if (changed) start_newcomers(input);
  for (std::uint32_t joint = 0; joint < actuation.joint_count; ++joint) {
    actuation.joints[joint] = {};
    writers_[joint] = 0;
  }
  for (const Member& member : plans_[active_].members) {
    if (tick % member.divisor == 0 || changed) {
      const ControlInput slower{input.joints, input.status, input.last, input.time_ns, input.dt_s * member.divisor};
      objects_[member.object]->step(slower, *proposals_[member.object]);
    }
    compose_joints(member, actuation);
  }
  if (changed && !first) switchover_.begin(input.joints, input.dt_s, input.last, actuation);
  switchover_.apply(input.joints, input.dt_s, actuation);
}

void ControlSets::fill(std::uint32_t& active_set, std::uint32_t& count,
                       std::array<ObjectStatus, max_objects>& status) const noexcept {
  active_set = active_;
  count = static_cast<std::uint32_t>(objects_.size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    status[i] = {.active = (running_ >> i & 1U) != 0, .motion_remaining_s = objects_[i]->motion_remaining_s()};
  }
}

void ControlSets::update(std::uint64_t behavior_tick, const Snapshot& snapshot) {
  for (const std::uint32_t index : catalog_.sets.at(snapshot.control_set).objects) {
    if (behavior_tick % catalog_.objects[index].high_level_divisor == 0) objects_[index]->update(snapshot);
  }
}

}  // namespace kadans
