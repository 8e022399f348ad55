// All control objects and the sets in which they work together. Sets are built and checked before the loop; one of them
// is active. Objects of the active set compute in the order of the set; a joint that none of them drives is off.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/control/control_object.h"

namespace kadans {

class ControlSets {
 public:
  // Keeps a reference to the catalog. `objects` as numbered there. Throws std::invalid_argument on a set that names no
  // object or an object twice, on two objects of a set that drive the same joint, and on too many objects.
  ControlSets(const Catalog& catalog, std::vector<std::unique_ptr<ControlObject>> objects);

  // Control thread. Computes the actuation of the active set's joints; the others' is left as it is.
  void step(std::uint64_t tick, const ControlInput& input, ActuationFrame& actuation) noexcept;
  // Control thread. The set computes from the next step on; objects that were not active start from the present state.
  void switch_to(std::uint32_t set) noexcept { active_ = set; }
  // Control thread, before step. `object` is an index in the catalog.
  ControlObject& object(std::uint32_t index) noexcept { return *objects_[index]; }
  void fill(std::uint32_t& active_set, std::uint32_t& count, std::array<ObjectStatus, max_objects>& status) const noexcept;

  // Behavior thread: the high level of all objects of the set that the snapshot calls active.
  void update(std::uint64_t behavior_tick, const Snapshot& snapshot);

  std::uint32_t active() const noexcept { return active_; }
  std::size_t size() const noexcept { return objects_.size(); }

 private:
  void change_over(const ControlInput& input, ActuationFrame& actuation) noexcept;

  const Catalog& catalog_;
  std::vector<std::unique_ptr<ControlObject>> objects_;
  std::vector<char> running_;  // by object
  std::uint32_t active_;
  std::uint32_t computing_;  // the set of the last step; size of the catalog's sets before the first
};

}  // namespace kadans
