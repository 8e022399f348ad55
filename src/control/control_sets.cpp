#include "kadans/control/control_sets.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace kadans {
namespace {

constexpr JointMask all_joints = ~JointMask{0};

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
      partition_(catalog),
      dwell_(catalog, partition_),
      switchover_(catalog.drives, catalog.switching),
      unheld_(catalog.unheld),
      active_(catalog.initial_sets) {
  if (objects_.size() > max_objects) {
    throw std::invalid_argument(std::to_string(objects_.size()) + " control objects, at most " +
                                std::to_string(max_objects) + " are possible");
  }
  if (objects_.size() != catalog.objects.size()) throw std::invalid_argument("the catalog lists other control objects");
  for (const ControlSetInfo& set : catalog.sets) check_set(catalog, set);
  check_drives();
  if (active_ == 0 || static_cast<std::size_t>(std::bit_width(active_)) > catalog.sets.size()) {
    throw std::invalid_argument("there is no initial control set");
  }
  if (partition_.clash(active_, active_)) throw std::invalid_argument("the initial control sets share a joint");
  for (std::size_t i = 0; i < objects_.size(); ++i) proposals_.push_back(std::make_unique<ActuationFrame>());
  plans_.reserve(catalog.sets.size());  // parameters point into the members
  for (const ControlSetInfo& set : catalog.sets) make_plan(catalog, set);
  declare(catalog);
  SetpointState ignored;
  for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) {
    const Setpoint& setpoint = catalog.setpoints[id];
    if (objects_[setpoint.owner]->setpoint_state(setpoint.channel, ignored)) catalog.setpoints.set_follows(id);
  }
}

void ControlSets::check_drives() {
  JointMask driven = 0;
  for (const std::uint32_t index : catalog_.at_drives) {
    const ObjectInfo& object = catalog_.objects.at(index);
    at_drives_ |= ObjectMask{1} << index;
    for (const ControlSetInfo& set : catalog_.sets) {
      if (std::ranges::find(set.objects, index) == set.objects.end()) continue;
      throw std::invalid_argument("control object " + object.name + " stands at the drives and in control set " +
                                  set.name);
    }
    for (const std::size_t joint : object.joints) {
      if ((std::exchange(driven, driven | joint_bit(joint)) & joint_bit(joint)) == 0) continue;
      throw std::invalid_argument("two control objects stand at the drive of joint " +
                                  catalog_.model->joints.at(joint).name);
    }
  }
}

void ControlSets::make_plan(Catalog& catalog, const ControlSetInfo& set) {
  Plan& plan = plans_.emplace_back();
  plan.reserve(set.objects.size());
  for (std::size_t i = 0; i < set.objects.size(); ++i) {
    const std::uint32_t index = set.objects[i];
    const ObjectInfo& object = catalog.objects[index];
    const Composition composition = set.compositions.empty() ? Composition::set : set.compositions[i];
    plan.push_back({index, object.divisor, composition, 1});
    if (composition != Composition::blend) continue;
    catalog.parameters.add({set.name + "." + object.name + ".weight", "", 0, 1, 1,
                            "Share of the object in the actuation of the joints that it blends."},
                           &plan.back().weight, max_objects);
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
  dwell_.declare(catalog.signals);
}

// What objects that go on add to a joint stays. An object that took over the torque with it would give it a second
// time.
void ControlSets::take_off_sums(const Member& member, ActuationFrame& last, JointStates& joints) const noexcept {
  each_bit(active_, [&](std::uint32_t set) {
    for (const Member& other : plans_[set]) {
      if (!goes_on_as_sum(other)) continue;
      const auto& theirs = catalog_.objects[other.object].joints;
      for (const std::size_t joint : catalog_.objects[member.object].joints) {
        const double effort_Nm = proposals_[other.object]->joints[joint].effort_Nm;
        if (std::ranges::find(theirs, joint) == theirs.end() || !std::isfinite(effort_Nm)) continue;
        last.joints[joint].effort_Nm -= effort_Nm;
        joints.joints[joint].effort_Nm -= effort_Nm;
      }
    }
  });
}

void ControlSets::start_newcomers(const ControlInput& input) noexcept {
  bool sums = false;  // mostly there are none, and frames are large
  each_bit(active_, [&](std::uint32_t set) {
    sums = sums || std::ranges::any_of(plans_[set], [&](const Member& member) { return goes_on_as_sum(member); });
  });
  each_bit(active_, [&](std::uint32_t set) {
    for (const Member& member : plans_[set]) {
      const ObjectMask bit = ObjectMask{1} << member.object;
      if ((running_ & bit) != 0) continue;
      fresh_ |= bit;
      if (!sums || member.composition != Composition::set) {
        objects_[member.object]->start(input);
        continue;
      }
      ActuationFrame last = input.last;
      JointStates joints = input.joints;
      take_off_sums(member, last, joints);
      objects_[member.object]->start({joints, input.status, last, input.time_ns, input.dt_s});
    }
  });
  running_ = partition_.objects(active_);
  dwell_.note(active_, input.time_ns);
}

void ControlSets::switch_to(std::uint32_t set) noexcept {
  const SetMask before = std::exchange(active_, partition_.after(active_, set));
  touched_ |= partition_.joints(before ^ active_);
}

void ControlSets::restart(const ControlInput& input) noexcept {
  running_ = 0;
  touched_ = all_joints;
  unheld_.forget();
  start_newcomers(input);
}

void ControlSets::compose_joints(const Member& member, Writers& writers, ActuationFrame& actuation) const noexcept {
  const ActuationFrame& proposal = *proposals_[member.object];
  const std::uint32_t bit = 1U << member.object;
  if (member.composition == Composition::set) {  // mostly
    for (const std::size_t joint : catalog_.objects[member.object].joints) {
      actuation.joints[joint] = proposal.joints[joint];
      writers[joint] = bit;
    }
    return;
  }
  const bool replaces = member.composition == Composition::priority;
  for (const std::size_t joint : catalog_.objects[member.object].joints) {
    if (!compose(member.composition, member.weight, proposal.joints[joint], actuation.joints[joint])) continue;
    writers[joint] = replaces ? bit : writers[joint] | bit;
  }
}

void ControlSets::step(std::uint64_t tick, const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool first = !std::exchange(computed_, true);
  const JointMask touched = std::exchange(touched_, 0) | (first ? all_joints : 0);
  switchover_.observe(input.joints, input.dt_s);
  if (touched != 0) {
    start_newcomers(input);
    unheld_.let_go(partition_.joints(active_), input.joints);
  }
  for (std::uint32_t joint = 0; joint < actuation.joint_count; ++joint) {
    actuation.joints[joint] = {};
    writers_[joint] = 0;
  }
  each_bit(active_, [&](std::uint32_t set) {
    for (const Member& member : plans_[set]) {
      if (tick % member.divisor == 0 || (fresh_ >> member.object & 1U) != 0) {
        const ControlInput slower{input.joints, input.status, input.last, input.time_ns, input.dt_s * member.divisor};
        objects_[member.object]->step(slower, *proposals_[member.object]);
      }
      compose_joints(member, writers_, actuation);
    }
  });
  fresh_ = 0;
  unheld_.step(input.joints, actuation);
  if (touched != 0 && !first) switchover_.begin(input.joints, input.dt_s, input.last, actuation, touched);
  switchover_.apply(input.joints, input.dt_s, actuation);
  if (dwell_.demanded()) dwell_.step(input.time_ns, input.dt_s);
}

void ControlSets::drive(const ControlInput& input, JointMask blind, ActuationFrame& actuation) noexcept {
  for (const std::uint32_t index : catalog_.at_drives) {
    ActuationFrame& motors = *proposals_[index];
    copy_used(actuation, motors);
    objects_[index]->step(input, motors);
    for (const std::size_t joint : catalog_.objects[index].joints) {
      if ((blind & joint_bit(joint)) == 0) actuation.joints[joint] = motors.joints[joint];
    }
  }
}

void ControlSets::rehearse(std::uint64_t tick, const ControlInput& input, ActuationFrame& scratch) const noexcept {
  for (const std::uint32_t index : catalog_.at_drives) {
    objects_[index]->rehearse(input);
    for (const std::size_t joint : catalog_.objects[index].joints)
      scratch.joints[joint] = proposals_[index]->joints[joint];
  }
  Writers writers{};
  each_bit(active_, [&](std::uint32_t set) {
    for (const Member& member : plans_[set]) {
      if (tick % member.divisor == 0) objects_[member.object]->rehearse(input);
      compose_joints(member, writers, scratch);
    }
  });
  unheld_.step(input.joints, scratch);
}

void ControlSets::fill(Snapshot& snapshot) const noexcept {
  snapshot.control_sets = active_;
  snapshot.object_count = static_cast<std::uint32_t>(objects_.size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    snapshot.objects[i] = {.active = runs(static_cast<std::uint32_t>(i)),
                           .motion_remaining_s = objects_[i]->motion_remaining_s()};
  }
  for (std::uint32_t i = 0; dwell_.demanded() && i < objects_.size(); ++i)
    snapshot.objects[i].dwell_s = static_cast<float>(dwell_.left_s(i));
}

void ControlSets::pass_state(StateBytes& bytes) noexcept {
  bytes(active_, running_, fresh_, touched_, computed_, dwell_, switchover_, unheld_);
  for (std::uint32_t& writers : writers_) bytes(writers);
  bytes.must(active_ != 0 && static_cast<std::size_t>(std::bit_width(active_)) <= plans_.size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    for (const std::size_t joint : catalog_.objects[i].joints) {
      JointActuation& proposal = proposals_[i]->joints[joint];
      bytes(proposal);
      bytes.must(proposal.mode <= last_actuation_mode);
    }
  }
  for (const auto& object : objects_) object->pass_state(bytes);
}

HandOvers ControlSets::hand_overs() const noexcept {
  HandOvers all;
  for (const auto& object : objects_) object->hand_overs(all);
  return all;
}

void ControlSets::update(std::uint64_t behavior_tick, const Snapshot& snapshot) {
  each_bit(snapshot.control_sets, [&](std::uint32_t set) {
    for (const Member& member : plans_.at(set)) {
      if (behavior_tick % catalog_.objects[member.object].high_level_divisor == 0)
        objects_[member.object]->update(snapshot);
    }
  });
}

}  // namespace kadans
