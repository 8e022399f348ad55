#include "kadans/control/set_partition.h"

#include <stdexcept>
#include <string>

namespace kadans {

SetPartition::SetPartition(const Catalog& catalog) : sets_(catalog.sets.size()) {
  if (sets_.size() > max_control_sets) {
    throw std::invalid_argument(std::to_string(sets_.size()) + " control sets, at most " +
                                std::to_string(max_control_sets) + " are possible");
  }
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    for (const std::uint32_t object : catalog.sets[i].objects) {
      sets_[i].objects |= ObjectMask{1} << object;
      for (const std::size_t joint : catalog.objects.at(object).joints) sets_[i].joints |= joint_bit(joint);
    }
  }
  for (std::uint32_t a = 0; a < sets_.size(); ++a) {
    for (std::uint32_t b = 0; b < sets_.size(); ++b) {
      const bool share = (sets_[a].joints & sets_[b].joints) != 0 || (sets_[a].objects & sets_[b].objects) != 0;
      if (a != b && share) sets_[a].touched |= set_bit(b);
    }
  }
}

bool SetPartition::clash(SetMask a, SetMask b) const noexcept {
  bool any = false;
  each_bit(a, [&](std::uint32_t set) { any = any || (sets_[set].touched & b) != 0; });
  return any;
}

JointMask SetPartition::joints(SetMask sets) const noexcept {
  JointMask all = 0;
  each_bit(sets, [&](std::uint32_t set) { all |= sets_[set].joints; });
  return all;
}

ObjectMask SetPartition::objects(SetMask sets) const noexcept {
  ObjectMask all = 0;
  each_bit(sets, [&](std::uint32_t set) { all |= sets_[set].objects; });
  return all;
}

}  // namespace kadans
