// Why the transitions of a behavior's active states were not taken, for people who look on.
//
// Guards are asked in a copy of the behavior: the files are loaded anew, the copy goes on from what a reload would
// carry over, and it is thrown away. So a question changes nothing, whatever a guard does, and costs as much as a
// reload. It is asked between two ticks on the behavior thread, within the budget of a reload and that of a tick.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace kadans {

// Where the function of a `when` is written.
struct GuardSource {
  static constexpr std::size_t lines_max = 12, line_max = 160;  // characters of a line

  std::string file;  // "": there is no guard
  int line = 0;
  std::string text{};  // its lines, without what all of them begin with
};

struct TransitionReason {
  std::uint16_t transition = 0;  // in the chart
  std::string from, to, label;
  bool free = false;  // nothing holds it back: the next tick takes it, or one that goes before it
  std::string why;    // "0.43 s left of 2 s; the guard says false"
  std::string saw{};  // what the guard reads: "s.base.pitch_rad = 0.02"
  GuardSource guard{};
};

struct BehaviorReasons {
  std::string name;
  std::vector<TransitionReason> transitions;
};

// Lines for a console.
std::string reasons_text(const std::vector<BehaviorReasons>& behaviors);

}  // namespace kadans
