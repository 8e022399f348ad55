#include "machine_sets.h"

#include <algorithm>
#include <bit>
#include <cstdio>

#include "script/check/hint.h"

namespace kadans {
namespace {

// "'legs'", "'legs' and 'arms'", "'a', 'b' and 'c'"
std::string names_of_sets(const Catalog& catalog, SetMask sets) {
  std::string text;
  each_bit(sets, [&](std::uint32_t set) {
    const bool last = (sets >> set) == 1;
    text += (text.empty() ? "'" : last ? " and '" : ", '") + catalog.sets[set].name + "'";
  });
  return text;
}

SetMessage message(const std::string& text) {
  SetMessage result{};
  std::snprintf(result.data(), result.size(), "%s", text.c_str());
  return result;
}

struct SetFinder {
  Behavior::Parts& parts;
  Chart& chart;
  const SetPartition& partition;

  void run() {
    for (StateIndex index = 0; index < chart.size(); ++index) name(index);
    for (StateIndex index = 0; index < chart.size(); ++index) {
      if (chart.states[index].kind == Chart::Kind::parallel) regions(index);
    }
  }

  void problem(const Chart::State& state, const std::string& near, const std::string& text) {
    parts.problems.push_back({state.chunk, parts.lua->line_of(state.chunk, state.line, near), 0, text});
  }

  void name(StateIndex index) {
    Chart::State& state = chart.states[index];
    if (state.controls.empty()) {
      state.sets = state.parent == no_state ? 0 : chart.states[state.parent].sets;
      return;
    }
    for (const std::string& name : state.controls) {
      const auto found = std::ranges::find(parts.catalog.sets, name, &ControlSetInfo::name);
      if (found == parts.catalog.sets.end()) {
        problem(state, name,
                "unknown control set '" + name + "' in 'controls'" + hint_text(name, names_of(parts.catalog.sets)));
      } else {
        state.sets |= set_bit(static_cast<std::uint32_t>(found - parts.catalog.sets.begin()));
      }
    }
    if (const std::string clash = clash_text(parts.catalog, state.sets, state.sets); !clash.empty())
      problem(state, state.controls.front(), "'controls' names sets that exclude each other: " + clash);
  }

  // Whether it can be active while nothing in it is.
  bool innermost(StateIndex index) const {
    const auto is_history = [&](StateIndex state) { return chart.states[state].kind == Chart::Kind::history; };
    bool inmost = !is_history(index);
    chart.each_child(index, [&](StateIndex child) { inmost = inmost && is_history(child); });
    return inmost;
  }
  SetMask sets_inside(StateIndex around) const {
    SetMask all = 0;
    for (StateIndex i = around; i < chart.states[around].end; ++i) {
      if (innermost(i)) all |= chart.states[i].sets;
    }
    return all;
  }
  // The first state in `around` whose sets clash with these.
  StateIndex clashing(StateIndex around, SetMask sets) const {
    for (StateIndex i = around; i < chart.states[around].end; ++i) {
      if (innermost(i) && partition.clash(chart.states[i].sets, sets)) return i;
    }
    return around;
  }
  // The state that names the sets on which `state` runs; `around` when that is not in it.
  StateIndex naming(StateIndex state, StateIndex around) const {
    while (state != around && chart.states[state].controls.empty()) state = chart.states[state].parent;
    return state;
  }

  // Each region of a parallel against those before it.
  void regions(StateIndex parallel) {
    const StateIndex first = static_cast<StateIndex>(parallel + 1), end = chart.states[parallel].end;
    for (StateIndex later = first; later < end; later = chart.states[later].end) {
      const SetMask sets = sets_inside(later);
      for (StateIndex region = first; region < later; region = chart.states[region].end) {
        if (!partition.clash(sets_inside(region), sets)) continue;
        const StateIndex one = clashing(region, sets), other = clashing(later, chart.states[one].sets);
        together(naming(one, region), naming(other, later), chart.states[one].sets, chart.states[other].sets);
        break;
      }
    }
  }

  void together(StateIndex one, StateIndex other, SetMask its, SetMask others) {
    if (chart.states[other].controls.empty()) {
      std::swap(one, other);
      std::swap(its, others);
    }
    if (chart.states[other].controls.empty()) return;  // sets from around the parallel, which were looked at there
    const std::string text =
        title(other) + " cannot be active beside " + title(one) + ": " + clash_text(parts.catalog, its, others) +
        "; the regions of a parallel run on the same control sets, or on sets without a common joint";
    const Chart::State& state = chart.states[other];
    if (!state.machine_root) return problem(state, state.controls.front(), text);
    const Chart::Machine& called = chart.machines[state.machine];
    parts.problems.push_back(
        {called.call_chunk, parts.lua->line_of(called.call_chunk, called.call_line, called.name), 0, text});
  }

  std::string title(StateIndex index) const {
    const Chart::State& state = chart.states[index];
    return state.machine_root ? "behavior '" + chart.machines[state.machine].name + "'" : "state '" + state.path + "'";
  }
};

}  // namespace

void find_control_sets(Behavior::Parts& parts) {
  Bindings& bindings = parts.bindings;
  bindings.partition.emplace(parts.catalog);
  SetFinder{parts, parts.chart, *bindings.partition}.run();
  bindings.machine_sets.assign(parts.chart.machines.size(), 0);
  bindings.machine_objects.assign(parts.chart.machines.size(), 0);
  for (const Chart::State& state : parts.chart.states) {
    bindings.all_sets |= state.sets;
    bindings.machine_sets[state.machine] |= state.sets;
    bindings.machine_objects[state.machine] |=
        state.sets == 0 ? ~ObjectMask{0} : bindings.partition->objects(state.sets);
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

SetMessage not_in_sets(const Bindings& bindings, const std::string& object, std::size_t machine) {
  const SetMask sets = bindings.machine_sets[machine];
  return message("control object '" + object + "' is not in this behavior's control set" +
                 (std::popcount(sets) > 1 ? "s, " : ", ") + names_of_sets(*bindings.catalog, sets));
}

SetMessage not_in_sets(const Bindings& bindings, std::uint32_t object, const Chart::State& state) {
  const Catalog& catalog = *bindings.catalog;
  const std::string& name = catalog.objects[object].name;
  std::string holding;
  for (std::uint32_t set = 0; set < catalog.sets.size() && holding.empty(); ++set) {
    if ((bindings.partition->objects(set_bit(set)) >> object & 1U) != 0) holding = catalog.sets[set].name;
  }
  const std::string sets = names_of_sets(catalog, state.sets);
  const std::string of = state.path.empty() ? "at the top of this behavior" : "of state '" + state.path + "'";
  return message("'" + name + "' is not in the control sets " + of + " (" + sets + "): give the state controls = \"" +
                 holding + "\"");
}

}  // namespace kadans
