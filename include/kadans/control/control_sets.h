// All control objects, and the control sets in which they work together. Sets are built and checked before the loop.
// The active sets have no joint in common (set_partition.h). The objects of an active set compute in the order of the
// set; their proposals for a joint are composed (composition.h). A joint that no active set holds does what the
// configuration says (set_partition.h). A change of the active sets makes no step in torque (switchover.h) and concerns
// only the joints of the sets that come or leave. It costs the start of the objects that come in, whatever the number
// of sets.
//
// Actuator-level objects are in no set and always active. They work after composition and the safety layer, in the tick
// that writes the actuation: each gets what is wanted of the joint and replaces it by what its motor shall do
// (spring_torque.h). All other objects still see joint torques, in ControlInput::last and everywhere.
//
// Signals     composition.<joint>.writers     the objects that have a share in its actuation, one bit each
//             composition.switch_share        the largest step that the last switch absorbed, as a share of the limit
//             composition.<set>.dwell_s       of a set that can dwell (switch_dwell.h)
// Parameters  <set>.<object>.weight           of an object that blends
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/control/control_object.h"
#include "kadans/control/set_partition.h"
#include "kadans/control/switch_dwell.h"
#include "kadans/control/switchover.h"

namespace kadans {

class ControlSets {
 public:
  // Keeps a reference to the catalog, declares signals and parameters in it, and marks the set-points that can be led
  // along a planned motion. `objects` are in the order of the catalog. Throws std::invalid_argument on a set without
  // objects or with one twice, on an object that sets a joint which an earlier object of the set drives, on an
  // actuator-level object that is in a set or shares a joint with another one, on initial sets that share a joint, and
  // on too many objects or sets.
  ControlSets(Catalog& catalog, std::vector<std::unique_ptr<ControlObject>> objects);

  // Control thread. Computes the actuation of all joints.
  void step(std::uint64_t tick, const ControlInput& input, ActuationFrame& actuation) noexcept;
  // Control thread, in the wait before a tick: computes what drive and step would, on copies.
  void rehearse(std::uint64_t tick, const ControlInput& input, ActuationFrame& scratch) const noexcept;
  // Control thread, before step. From the next step on the set computes, in place of the active sets that share a joint
  // with it. Objects that were not active start from the present state: in that step, or already in start_newcomers, so
  // that they can get set-points before the step. Nothing changes when the set is already active.
  void switch_to(std::uint32_t set) noexcept;
  void start_newcomers(const ControlInput& input) noexcept;
  // Control thread, before step. All objects of the active sets start anew, as if they had just been switched to.
  void restart(const ControlInput& input) noexcept;
  // Control thread, after the safety layer and before the plant is written: runs the actuator-level objects. `blind`:
  // joints that are not measured in this tick; they keep what is in `actuation`.
  void drive(const ControlInput& input, JointMask blind, ActuationFrame& actuation) noexcept;
  bool drives() const noexcept { return at_drives_ != 0; }  // whether drive() does anything
  // Between ticks: all that changes from tick to tick (state_bytes.h), the states of the objects after it.
  void pass_state(StateBytes& bytes) noexcept;
  // Control thread, before step. `index` counts as in the catalog.
  ControlObject& object(std::uint32_t index) noexcept { return *objects_[index]; }
  void fill(Snapshot& snapshot) const noexcept;  // which sets and objects are active

  // Behavior thread: runs the high level of all objects of the sets that are active in the snapshot.
  void update(std::uint64_t behavior_tick, const Snapshot& snapshot);

  SetMask active() const noexcept { return active_; }
  const SetPartition& partition() const noexcept { return partition_; }
  const SwitchDwell& dwell() const noexcept { return dwell_; }  // control thread
  bool runs(std::uint32_t object) const noexcept { return ((running_ | at_drives_) >> object & 1U) != 0; }
  // Control thread: whether the object started since the last step.
  bool fresh(std::uint32_t object) const noexcept { return (fresh_ >> object & 1U) != 0; }
  std::size_t size() const noexcept { return objects_.size(); }
  // Before the loop: the storages between the levels of all objects.
  HandOvers hand_overs() const noexcept;

 private:
  struct Member {
    std::uint32_t object;
    std::uint32_t divisor;
    Composition composition;
    double weight;
  };
  using Plan = std::vector<Member>;  // a set, laid out for the tick
  void make_plan(Catalog& catalog, const ControlSetInfo& set);
  bool goes_on_as_sum(const Member& member) const noexcept {
    return member.composition == Composition::sum && (running_ >> member.object & 1U) != 0;
  }
  void take_off_sums(const Member& member, ActuationFrame& last, JointStates& joints) const noexcept;
  void declare(Catalog& catalog);
  void check_drives();
  using Writers = std::array<std::uint32_t, max_joints>;  // by joint: the objects that have a share, one bit each
  void compose_joints(const Member& member, Writers& writers, ActuationFrame& actuation) const noexcept;

  const Catalog& catalog_;
  std::vector<std::unique_ptr<ControlObject>> objects_;
  std::vector<std::unique_ptr<ActuationFrame>> proposals_;  // by object; kept in ticks that an object's divisor skips
  std::vector<Plan> plans_;                                 // by set
  Writers writers_{};
  SetPartition partition_;
  SwitchDwell dwell_;
  Switchover switchover_;
  UnheldJoints unheld_;
  ObjectMask running_ = 0;
  ObjectMask fresh_ = 0;  // started since the last step
  ObjectMask at_drives_ = 0;
  SetMask active_;
  JointMask touched_ = 0;  // joints of the sets that came or left since the last step
  bool computed_ = false;  // at least one step
};

}  // namespace kadans
