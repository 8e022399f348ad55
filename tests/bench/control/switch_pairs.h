// Every control set switched to every other while a hanging TULip rests, moves, bears a load or is saturated: how large
// is the step in the drives' torque, from the last step of the plant under the old set to the first under the new one?
// The drives are rigid, so that nothing between motor and joint smooths it.
#pragma once

#include <string>
#include <vector>

namespace kadans::bench {

enum class Situation { rest, moving, load, saturated };
inline constexpr Situation situations[] = {Situation::rest, Situation::moving, Situation::load, Situation::saturated};
const char* name(Situation situation);

struct SwitchStep {
  std::string from, to;
  Situation situation = Situation::rest;
  double share = 0;          // of the joint's torque limit, over all joints
  double without_share = 0;  // what it would have been: the step that was absorbed
  std::string joint;         // where it was largest
};

// The sets of tests/bench/control/switching_robot.json, and its bound of the step.
std::vector<std::string> switch_sets();
double switch_step_max();
SwitchStep measure_switch(const std::string& from, const std::string& to, Situation situation);

// What switching adds to the tick: median over many switches, in ns.
double switch_cost_ns(const std::string& from, const std::string& to);

}  // namespace kadans::bench
