#include "kadans/control/switch_dwell.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kadans {
namespace {

std::int64_t dwell_ns(const std::string& what, double dwell_s) {
  if (dwell_s >= 0 && dwell_s <= switch_dwell_max_s) return std::llround(1e9 * dwell_s);
  throw std::invalid_argument(what + ": switch_dwell_s is " + std::to_string(dwell_s) + ", must be 0.." +
                              std::to_string(static_cast<int>(switch_dwell_max_s)) + " s");
}

}  // namespace

SwitchDwell::SwitchDwell(const Catalog& catalog, const SetPartition& partition)
    : catalog_(catalog),
      partition_(partition),
      active_(catalog.initial_sets & static_cast<SetMask>((std::uint64_t{1} << catalog.sets.size()) - 1)),
      running_(partition.objects(active_)) {
  for (const ControlSetInfo& set : catalog.sets)
    sets_.push_back({.demanded_ns = dwell_ns("control set " + set.name, set.switch_dwell_s)});
  for (const ObjectInfo& object : catalog.objects)
    objects_.push_back({.demanded_ns = dwell_ns("control object " + object.name, object.switch_dwell_s)});
  const auto demands = [](const Stay& stay) { return stay.demanded_ns > 0; };
  demanded_ = std::ranges::any_of(sets_, demands) || std::ranges::any_of(objects_, demands);
}

void SwitchDwell::declare(SignalTable& signals) const {
  for (std::uint32_t set = 0; set < sets_.size(); ++set) {
    bool demands = sets_[set].demanded_ns > 0;
    for (const std::uint32_t object : catalog_.sets[set].objects) demands = demands || objects_[object].demanded_ns > 0;
    if (!demands) continue;
    signals.add({"composition." + catalog_.sets[set].name + ".dwell_s", "s",
                 "For how long a switch to or away from it will still be refused in the next tick."},
                &left_s_[set]);
  }
}

void SwitchDwell::note(SetMask active, std::int64_t time_ns) noexcept {
  if (!demanded_) return;
  const ObjectMask running = partition_.objects(active);
  const auto begin = [time_ns](Stay& stay) { stay.until_ns = time_ns + stay.demanded_ns; };
  each_bit(active ^ active_, [&](std::uint32_t set) { begin(sets_[set]); });
  each_bit(running ^ partition_.objects(active_), [&](std::uint32_t object) { begin(objects_[object]); });
  active_ = active;
  running_ = running;
}

void SwitchDwell::step(std::int64_t time_ns, double dt_s) noexcept {
  next_ns_ = time_ns + std::llround(1e9 * dt_s);
  for (std::uint32_t set = 0; set < sets_.size(); ++set) {
    std::int64_t left = left_ns(sets_[set], false, next_ns_);
    for (const std::uint32_t object : catalog_.sets[set].objects)
      left = std::max(left, left_ns(objects_[object], false, next_ns_));
    left_s_[set] = 1e-9 * static_cast<double>(left);
  }
}

std::int64_t SwitchDwell::left_ns(const Stay& stay, bool changed, std::int64_t time_ns) noexcept {
  return changed ? stay.demanded_ns : std::max<std::int64_t>(stay.until_ns - time_ns, 0);
}

SwitchDwell::Dweller SwitchDwell::against(SetMask active, std::uint32_t set, std::int64_t time_ns) const noexcept {
  if (!demanded_) return {};
  const SetMask after = partition_.after(active, set);
  const ObjectMask before = partition_.objects(active), switched = before ^ partition_.objects(after);
  Dweller found;
  each_bit(active ^ after, [&](std::uint32_t which) {
    std::int64_t left = left_ns(sets_[which], ((active ^ active_) & set_bit(which)) != 0, time_ns);
    each_bit(switched & partition_.objects(set_bit(which)), [&](std::uint32_t object) {
      left = std::max(left, left_ns(objects_[object], ((before ^ running_) >> object & 1U) != 0, time_ns));
    });
    const double left_s = 1e-9 * static_cast<double>(left);
    if (left_s > found.left_s) found = {which, left_s};
  });
  return found;
}

double SwitchDwell::left_s(std::uint32_t object) const noexcept {
  std::int64_t left = left_ns(objects_[object], false, next_ns_);
  for (std::uint32_t set = 0; set < sets_.size(); ++set) {
    if ((partition_.objects(set_bit(set)) >> object & 1U) != 0)
      left = std::max(left, left_ns(sets_[set], false, next_ns_));
  }
  return 1e-9 * static_cast<double>(left);
}

}  // namespace kadans
