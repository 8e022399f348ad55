// Lets a run part from the one it was, between two ticks: other parameters of control objects, something else to play,
// a push. What the plant is made of stays: a robot does not change its masses while it moves.
#pragma once

#include <string>
#include <vector>

#include "kadans/app/assembly.h"
#include "kadans/scenario/pushes.h"
#include "kadans/telemetry/run_inputs.h"
#include "run_request.h"

namespace kadans {

// "softer: set control.*.kp_Nm_per_rad_scale=0.5; push torso=0,2,0; play wave". Throws InputError.
RunBranch parse_branch(const std::string& text);
std::string branch_text(const RunBranch& branch);

// What a branch does to a run.
class BranchActions {
 public:
  // Throws InputError for a parameter, a link or a behavior that there is not, and for a value out of its range.
  BranchActions(const RunBranch& branch, const ScenarioConfig& scenario, Assembly& assembly, double at_s);

  void begin(const RunMark& mark);  // once, between two ticks
  // After begin(), between two ticks: the pushes of the next.
  void between_ticks(const RunMark& mark) const;

 private:
  struct Setting {
    ParameterId parameter = 0;
    double number = 0;
    bool scale = false;  // of what it is at the branch
  };
  void read_setting(const NumberEntry& setting, const ParameterTable& parameters);

  Assembly& assembly_;
  std::vector<Setting> settings_;
  std::vector<PlayItem> play_;
  Pushes pushes_;
};

}  // namespace kadans
