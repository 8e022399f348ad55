#include "machine_sets.h"

#include <algorithm>

#include "script/check/hint.h"

namespace kadans {
namespace {

const ControlSetInfo* find_set(Behavior::Parts& parts, const Chart::Machine& machine) {
  std::vector<std::string> names;
  for (const ControlSetInfo& set : parts.catalog.sets) {
    names.push_back(set.name);
    if (set.name == machine.controls) return &set;
  }
  const Chart::State& root = parts.chart.states[machine.root];
  parts.problems.push_back(
      {root.chunk, parts.lua->line_of(root.chunk, root.line, machine.controls), 0,
       "unknown control set '" + machine.controls + "' in 'controls'" + hint_text(machine.controls, names)});
  return nullptr;
}

// Whether both can be active: one is inside the other, or the innermost state around both is a parallel.
bool together(const Chart& chart, StateIndex a, StateIndex b) {
  StateIndex around = std::max(a, b);
  const StateIndex other = std::min(a, b);
  while (!chart.inside(other, around) && !chart.inside(around, other)) {
    const StateIndex parent = chart.states[around].parent;
    if (chart.inside(other, parent)) return chart.states[parent].kind == Chart::Kind::parallel;
    around = parent;
  }
  return true;
}

SetMask bit_of(const Catalog& catalog, const ControlSetInfo* set) {
  return set == nullptr ? 0 : set_bit(static_cast<std::uint32_t>(set - catalog.sets.data()));
}

// A behavior that is called, against those before it in the chart.
void check_together(Behavior::Parts& parts, std::size_t number) {
  const Chart& chart = parts.chart;
  const Chart::Machine& called = chart.machines[number];
  for (std::size_t i = 0; i < number; ++i) {
    const Chart::Machine& other = chart.machines[i];
    const std::string clash = clash_text(parts.catalog, bit_of(parts.catalog, parts.bindings.sets[i]),
                                         bit_of(parts.catalog, parts.bindings.sets[number]));
    if (clash.empty() || !together(chart, other.root, called.root)) continue;
    const bool caller = chart.inside(called.root, other.root);
    parts.problems.push_back(
        {called.call_chunk, parts.lua->line_of(called.call_chunk, called.call_line, called.name), 0,
         "behavior '" + called.name + "' cannot play " + (caller ? "inside" : "beside") + " '" + other.name + "': " +
             clash + "; a called or parallel behavior uses its caller's control set, or one with joints of its own"});
    return;
  }
}

}  // namespace

void find_control_sets(Behavior::Parts& parts) {
  const Chart& chart = parts.chart;
  auto& sets = parts.bindings.sets;
  for (const Chart::Machine& machine : chart.machines) {
    const StateIndex caller = chart.states[machine.root].parent;
    const ControlSetInfo* inherited = caller == no_state ? nullptr : sets[chart.states[caller].machine];
    sets.push_back(machine.controls.empty() ? inherited : find_set(parts, machine));
  }
  for (std::size_t i = 1; i < sets.size(); ++i) {
    if (!chart.machines[i].controls.empty()) check_together(parts, i);
  }
}

std::string clash_text(const Catalog& catalog, SetMask a, SetMask b) {
  std::string text;
  const SetPartition partition(catalog);
  each_bit(a, [&](std::uint32_t one) {
    each_bit(b, [&](std::uint32_t other) {
      if (!text.empty() || !partition.clash(set_bit(one), set_bit(other))) return;
      const JointMask shared = partition.joints(set_bit(one)) & partition.joints(set_bit(other));
      const auto joint = static_cast<std::size_t>(std::countr_zero(shared));
      text = "control sets '" + catalog.sets[one].name + "' and '" + catalog.sets[other].name + "' both drive " +
             (shared != 0 ? "joint '" + catalog.model->joints[joint].name + "'" : "the same control object");
    });
  });
  return text;
}

}  // namespace kadans
