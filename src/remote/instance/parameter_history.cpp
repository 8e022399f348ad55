#include "parameter_history.h"

namespace kadans {

void ParameterHistory::note(const ParameterChange& change, bool lasting) {
  if (steps_.size() == steps_max) {
    steps_.erase(steps_.begin());
    lasting_.erase(lasting_.begin());
  }
  steps_.push_back(change);
  lasting_.push_back(lasting);
  if (lasting) move_on(change);
}

void ParameterHistory::drop() {
  const ParameterChange step = steps_.back();
  const bool lasting = lasting_.back();
  steps_.pop_back();
  lasting_.pop_back();
  if (lasting) move_on({step.name, step.now, step.before, step.chunk});
}

void ParameterHistory::move_on(const ParameterChange& change) {
  for (auto* const known : {&unsaved_, &set_}) {
    ParameterChange& all = known->try_emplace(change.name, change).first->second;
    all.now = change.now;
    if (all.now == all.before) known->erase(change.name);
  }
}

void ParameterHistory::saved(const std::vector<ParameterChange>& changes) {
  for (const ParameterChange& change : changes) {
    const auto found = unsaved_.find(change.name);
    if (found == unsaved_.end()) continue;
    found->second.before = change.now;
    if (found->second.now == change.now) unsaved_.erase(found);
  }
}

std::vector<ParameterChange> ParameterHistory::unsaved() const {
  std::vector<ParameterChange> all;
  for (const auto& [name, change] : unsaved_) all.push_back(change);
  return all;
}

std::vector<ParameterChange> ParameterHistory::set() const {
  std::vector<ParameterChange> all;
  for (const auto& [name, change] : set_) all.push_back(change);
  return all;
}

}  // namespace kadans
