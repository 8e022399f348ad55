// All control objects and the sets in which they work together. Sets are built and checked before the loop; one of them
// is active. Objects of the active set compute in the order of the set, and compose what they propose for a joint
// (composition.h); a joint that none of them drives is off. A change of the active set makes no step (switchover.h) and
// costs the starting of the objects that come in, whatever the number of sets.
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
#include "kadans/control/switchover.h"

namespace kadans {

class ControlSets {
 public:
  // Keeps a reference to the catalog and declares signals and parameters in it. `objects` as numbered there. Throws
  // std::invalid_argument on a set that names no object or an object twice, on an object that sets a joint which an
  // earlier one of the set drives, and on too many objects.
  ControlSets(Catalog& catalog, std::vector<std::unique_ptr<ControlObject>> objects);

  // Control thread. Computes the actuation of all joints.
  void step(std::uint64_t tick, const ControlInput& input, ActuationFrame& actuation) noexcept;
  // Control thread, before step. The set computes from the next step on; objects that were not active start from the
  // present state: in that step, or earlier by start_newcomers, so that they can be given set-points before it.
  void switch_to(std::uint32_t set) noexcept;
  void start_newcomers(const ControlInput& input) noexcept;
  // Control thread, before step. All objects of the active set start anew, as if it had just been switched to.
  void restart(const ControlInput& input) noexcept;
  // Control thread, before step. `object` is an index in the catalog.
  ControlObject& object(std::uint32_t index) noexcept { return *objects_[index]; }
  void fill(std::uint32_t& active_set, std::uint32_t& count,
            std::array<ObjectStatus, max_objects>& status) const noexcept;

  // Behavior thread: the high level of all objects of the set that the snapshot calls active.
  void update(std::uint64_t behavior_tick, const Snapshot& snapshot);

  std::uint32_t active() const noexcept { return active_; }
  bool runs(std::uint32_t object) const noexcept { return (running_ >> object & 1U) != 0; }
  std::size_t size() const noexcept { return objects_.size(); }

 private:
  struct Member {
    std::uint32_t object;
    std::uint32_t divisor;
    Composition composition;
    double weight;
  };
  struct Plan {  // a set, laid out for the tick
    std::vector<Member> members;
    std::uint32_t objects = 0;  // a bit an object
  };
  void make_plan(Catalog& catalog, const ControlSetInfo& set);
  void declare(Catalog& catalog);
  void compose_joints(const Member& member, ActuationFrame& actuation) noexcept;

  const Catalog& catalog_;
  std::vector<std::unique_ptr<ControlObject>> objects_;
  std::vector<std::unique_ptr<ActuationFrame>> proposals_;  // by object; stand while a slower object rests
  std::vector<Plan> plans_;                                 // by set
  std::array<std::uint32_t, max_joints> writers_{};
  Switchover switchover_;
  std::uint32_t running_ = 0;  // a bit an object
  std::uint32_t active_;
  bool computed_ = false;  // at least one step
  bool switched_ = false;  // since the last step
};

}  // namespace kadans
