// Maps the states of a chart to those of another version of it: states with the same path and kind that are both a
// machine's root or both not.
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "chart.h"

namespace kadans {

// For each state of `from` its number in `to`, or no_state.
inline std::vector<StateIndex> map_states(const Chart& from, const Chart& to) {
  std::unordered_map<std::string_view, StateIndex> known;
  for (StateIndex i = 0; i < to.size(); ++i) known.emplace(to.states[i].path, i);
  std::vector<StateIndex> map(from.states.size(), no_state);
  for (StateIndex i = 0; i < from.size(); ++i) {
    const Chart::State& wanted = from.states[i];
    if (wanted.parent != no_state && map[wanted.parent] == no_state) continue;
    const auto found = known.find(wanted.path);
    if (found == known.end()) continue;
    const Chart::State& same = to.states[found->second];
    if (same.kind == wanted.kind && same.machine_root == wanted.machine_root) map[i] = found->second;
  }
  return map;
}

}  // namespace kadans
