// Which state of a chart is which of another version of it: those of the same path, kind and machine.
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "kadans/script/chart.h"

namespace kadans {

// One a state of `from`: its number in `to`, or no_state.
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
