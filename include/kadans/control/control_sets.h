// All control objects and the sets in which they work together. Sets are built and checked before the loop; those that
// are active have no joint in common (set_partition.h). Objects of an active set compute in the order of the set, and
// compose what they propose for a joint (composition.h); a joint that no active set holds does what the configuration
// says (unheld_joints.h). A change of the active sets makes no step (switchover.h), concerns the joints of the sets
// that come or leave alone, and costs the starting of the objects that come in, whatever the number of sets.
//
// Objects that stand at the drives are in no set and always active. They work on what is left after composition and the
// safety layer, in the tick that writes it: what they are given is wanted of the joint, what they leave is asked of its
// motor (spring_torque.h). All others go on to see torques at joints, in ControlInput::last and everywhere.
//
// Signals     composition.<joint>.writers     the objects that have a share in its actuation, a bit each
//             composition.switch_share        the largest step that the last switch absorbed, as a share of the limit
// Parameters  <set>.<object>.weight           of an object that blends
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/control/control_object.h"
#include "kadans/control/set_partition.h"
#include "kadans/control/switchover.h"
#include "kadans/control/unheld_joints.h"

namespace kadans {

class ControlSets {
 public:
  // Keeps the catalog, declares signals and parameters in it, marks set-points that can be led. Throws
  // std::invalid_argument on a set that names no object or one twice, on an object that sets a joint which an earlier
  // one of the set drives, on initial sets that share a joint, and on too many objects (numbered as there) or sets.
  ControlSets(Catalog& catalog, std::vector<std::unique_ptr<ControlObject>> objects);

  // Control thread. Computes the actuation of all joints.
  void step(std::uint64_t tick, const ControlInput& input, ActuationFrame& actuation) noexcept;
  // Control thread, in the wait before a tick: what drive and step would compute, on copies.
  void rehearse(std::uint64_t tick, const ControlInput& input, ActuationFrame& scratch) const noexcept;
  // Control thread, before step. The set computes from the next step on, in place of the active ones that it shares a
  // joint with; objects that were not active start from the present state: in that step, or earlier by start_newcomers,
  // so that they can be given set-points before it. Nothing changes when it is active.
  void switch_to(std::uint32_t set) noexcept;
  void start_newcomers(const ControlInput& input) noexcept;
  // Control thread, before step. All objects of the active sets start anew, as if they had just been switched to.
  void restart(const ControlInput& input) noexcept;
  // Control thread, after the safety layer, before the plant is written. `blind`: joints that are not measured in this
  // tick; they keep what is in `actuation`.
  void drive(const ControlInput& input, JointMask blind, ActuationFrame& actuation) noexcept;
  bool drives() const noexcept { return at_drives_ != 0; }  // whether drive() does anything
  // Control thread, before step. `object` is an index in the catalog.
  ControlObject& object(std::uint32_t index) noexcept { return *objects_[index]; }
  void fill(Snapshot& snapshot) const noexcept;  // which sets and objects are active

  // Behavior thread: the high level of all objects of the sets that the snapshot calls active.
  void update(std::uint64_t behavior_tick, const Snapshot& snapshot);

  SetMask active() const noexcept { return active_; }
  const SetPartition& partition() const noexcept { return partition_; }
  bool runs(std::uint32_t object) const noexcept { return ((running_ | at_drives_) >> object & 1U) != 0; }
  std::size_t size() const noexcept { return objects_.size(); }

 private:
  struct Member {
    std::uint32_t object;
    std::uint32_t divisor;
    Composition composition;
    double weight;
  };
  using Plan = std::vector<Member>;  // a set, laid out for the tick
  void make_plan(Catalog& catalog, const ControlSetInfo& set);
  void declare(Catalog& catalog);
  void check_drives();
  using Writers = std::array<std::uint32_t, max_joints>;  // by joint: the objects that have a share, a bit each
  void compose_joints(const Member& member, Writers& writers, ActuationFrame& actuation) const noexcept;

  const Catalog& catalog_;
  std::vector<std::unique_ptr<ControlObject>> objects_;
  std::vector<std::unique_ptr<ActuationFrame>> proposals_;  // by object; stand while a slower object rests
  std::vector<Plan> plans_;                                 // by set
  Writers writers_{};
  SetPartition partition_;
  Switchover switchover_;
  UnheldJoints unheld_;
  ObjectMask running_ = 0;
  ObjectMask fresh_ = 0;  // started since the last step
  ObjectMask at_drives_ = 0;
  SetMask active_;
  JointMask touched_ = 0;  // of sets that came or left since the last step
  bool computed_ = false;  // at least one step
};

}  // namespace kadans
